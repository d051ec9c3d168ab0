"""Fold counting states: of a long run of states that differ only in a count, draw the ends."""

from __future__ import annotations

import re
from collections.abc import Mapping

from tltlc.automaton.fspa import Edge, Fspa, Guard, State
from tltlc.core.record import EMPTY, record, replace

LEAST_FOLDED = 3
"""A run with at least this many inner states is folded: five states with both ends."""

_number = re.compile(r"(\d+)")
_one_step = re.compile(r"\b1 step\b")


@record
class Drawing:
    """The states and edges that are drawn, in the automaton's order; edges have their marks (:func:`marked`).

    ``folded`` maps the first inner state of each run, which is drawn for all of them, to the run's
    inner states. Its edge along the run leads to the last state of the run.
    """

    states: tuple[State, ...]
    edges: tuple[Edge, ...]
    folded: Mapping[int, tuple[State, ...]] = EMPTY


def whole(fspa: Fspa) -> Drawing:
    """Return a drawing of every state and edge."""
    return Drawing(fspa.states, marked(fspa).edges)


def folded(fspa: Fspa) -> Drawing:
    """Return the drawing with the inner states of each run folded into one.

    A run is a path on which each state has an edge with the same guard to the next state (the last
    one: to another state), and all agree in verdict, acceptance and the guards and targets of their
    other edges. An inner state is entered only from the state before it, so distances stay equal or
    fall by one.
    """
    fspa = marked(fspa)
    runs = _inner_states(fspa)
    hidden = {state for run in runs for state, _ in run[1:]}
    shortened = {run[0][1]: run[-1][1].target for run in runs}
    edges = (replace(edge, target=shortened.get(edge, edge.target)) for edge in fspa.edges if edge.source not in hidden)
    return Drawing(
        tuple(state for state in fspa.states if state.id not in hidden),
        tuple(edges),
        {run[0][0]: tuple(fspa.states[state] for state, _ in run) for run in runs},
    )


def _inner_states(fspa: Fspa) -> list[list[tuple[int, Edge]]]:
    """Return the inner states of each run that is long enough, each with its edge along the run."""
    outgoing: list[list[Edge]] = [[] for _ in fspa.states]
    entering: list[list[Edge]] = [[] for _ in fspa.states]
    for edge in fspa.edges:
        outgoing[edge.source].append(edge)
        entering[edge.target].append(edge)
    along: dict[int, Edge] = {}
    for state in range(1, len(fspa.states)):  # not state 0, which the start of the trace also enters
        if len(entering[state]) == 1:
            onward = _onward(entering[state][0], fspa, outgoing)
            if onward is not None and _onward(onward, fspa, outgoing) is not None:
                along[state] = onward
    runs = []
    for state, edge in along.items():
        if entering[state][0].source not in along:
            run = [(state, edge)]
            while (following := run[-1][1].target) in along:
                run.append((following, along[following]))
            if len(run) >= LEAST_FOLDED:
                runs.append(run)
    return runs


def _onward(edge: Edge, fspa: Fspa, outgoing: list[list[Edge]]) -> Edge | None:
    """Return the edge that continues a run after this edge; None if its two states do not belong to one run."""
    source, target = fspa.states[edge.source], fspa.states[edge.target]
    if (source.verdict, source.accepting) != (target.verdict, target.accepting):
        return None
    other_edges = _without(edge, outgoing[source.id])
    for onward in outgoing[target.id]:
        if (
            onward.guard == edge.guard
            and onward.target != target.id
            and _without(onward, outgoing[target.id]) == other_edges
        ):
            return onward
    return None


def _without(left_out: Edge, edges: list[Edge]) -> list[tuple[Guard, int]]:
    return [(edge.guard, edge.target) for edge in edges if edge is not left_out]


def marked(fspa: Fspa) -> Fspa:
    """Return the automaton with the pairs that name an edge after the text of its guard: ``a & b [fin 0] [inf 1]``.

    Edges that differ only in their pairs then have different guards. Over finite traces the
    automaton is unchanged.
    """
    if not fspa.acceptance:
        return fspa
    edges = []
    for edge, marks in zip(fspa.edges, fspa.marks(), strict=True):
        text = " ".join([edge.guard.text, *(f"[{kind} {pair}]" for pair, kind in marks)])
        edges.append(replace(edge, guard=Guard(text, edge.guard.primes)))
    return replace(fspa, edges=tuple(edges))


def span(first: str, last: str) -> str:
    """Return two texts as one: with ranges if they differ only in numbers (``F[0,39…2] p``), else both."""
    for texts in ((first, last), [_one_step.sub("1 steps", text) for text in (first, last)]):
        first_parts, last_parts = map(_number.split, texts)
        if first_parts[::2] == last_parts[::2]:
            return "".join(a if a == b else f"{a}…{b}" for a, b in zip(first_parts, last_parts, strict=True))
    return f"{first} … {last}"
