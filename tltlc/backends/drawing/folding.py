"""Fold counting states: draw only the ends of a long run of states that differ only in a count."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from tltlc.automaton.fspa import Fspa, Guard, Mark, State
from tltlc.core.record import EMPTY, record, replace

LEAST_FOLDED = 3
"""A run is folded if it has at least this many inner states; with both ends, it then has five states."""

_number = re.compile(r"(\d+)")
_one_step = re.compile(r"\b1 step\b")


class EdgeLabel(NamedTuple):
    """The guard of an edge, and the sets of pairs that contain the edge: none over finite traces."""

    guard: Guard
    marks: tuple[Mark, ...]


@record
class DrawnEdge:
    """An edge of a drawing. Edges that differ only in their pairs have different labels."""

    source: int
    target: int
    label: EdgeLabel


@record
class Drawing:
    """The states and edges that are drawn, in the automaton's order.

    One state is drawn for all inner states of a folded run: the first of them. ``folded`` maps it
    to the inner states. Its edge along the run leads to the last state of the run.
    """

    states: tuple[State, ...]
    edges: tuple[DrawnEdge, ...]
    folded: Mapping[int, tuple[State, ...]] = EMPTY


def whole_drawing(fspa: Fspa) -> Drawing:
    """Return a drawing of every state and edge."""
    edges = (
        DrawnEdge(edge.source, edge.target, EdgeLabel(edge.guard, marks))
        for edge, marks in zip(fspa.edges, fspa.marks(), strict=True)
    )
    return Drawing(fspa.states, tuple(edges))


def fold_runs(fspa: Fspa) -> Drawing:
    """Return the drawing with the inner states of each run folded into one.

    A run is a path on which each state has an edge with the same label to the next state; the last
    state has such an edge to another state. All states of the path agree in verdict, acceptance and
    the labels and targets of their other edges. An inner state is entered only from the state
    before it, so distances stay equal or fall by one.
    """
    states, edges = fspa.states, whole_drawing(fspa).edges
    runs = _inner_runs(states, edges)
    hidden = {state for run in runs for state, _ in run[1:]}
    shortened = {run[0][1]: run[-1][1].target for run in runs}
    drawn_edges = (
        replace(edge, target=shortened.get(edge, edge.target)) for edge in edges if edge.source not in hidden
    )
    return Drawing(
        tuple(state for state in states if state.id not in hidden),
        tuple(drawn_edges),
        {run[0][0]: tuple(states[state] for state, _ in run) for run in runs},
    )


def _inner_runs(states: Sequence[State], edges: Sequence[DrawnEdge]) -> list[list[tuple[int, DrawnEdge]]]:
    """Return the inner states of each run that is long enough, each with its edge along the run."""
    outgoing: list[list[DrawnEdge]] = [[] for _ in states]
    entering: list[list[DrawnEdge]] = [[] for _ in states]
    for edge in edges:
        outgoing[edge.source].append(edge)
        entering[edge.target].append(edge)
    along: dict[int, DrawnEdge] = {}
    for state in range(1, len(states)):  # not state 0, which the start of the trace also enters
        if len(entering[state]) == 1:
            onward = _next_edge(entering[state][0], states, outgoing)
            if onward is not None and _next_edge(onward, states, outgoing) is not None:
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


def _next_edge(edge: DrawnEdge, states: Sequence[State], outgoing: list[list[DrawnEdge]]) -> DrawnEdge | None:
    """Return the edge that continues a run after this edge; None if its two states do not belong to one run."""
    source, target = states[edge.source], states[edge.target]
    if (source.verdict, source.accepting) != (target.verdict, target.accepting):
        return None
    other_edges = _without(edge, outgoing[source.id])
    for onward in outgoing[target.id]:
        if (
            onward.label == edge.label
            and onward.target != target.id
            and _without(onward, outgoing[target.id]) == other_edges
        ):
            return onward
    return None


def _without(left_out: DrawnEdge, edges: list[DrawnEdge]) -> list[tuple[EdgeLabel, int]]:
    return [(edge.label, edge.target) for edge in edges if edge is not left_out]


def text_range(first: str, last: str) -> str:
    """Return two texts as one: with ranges if they differ only in numbers (``F[0,39…2] p``), else both."""
    for texts in ((first, last), [_one_step.sub("1 steps", text) for text in (first, last)]):
        first_parts, last_parts = map(_number.split, texts)
        if first_parts[::2] == last_parts[::2]:
            return "".join(a if a == b else f"{a}…{b}" for a, b in zip(first_parts, last_parts, strict=True))
    return f"{first} … {last}"
