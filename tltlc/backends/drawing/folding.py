"""Fold long runs of states that differ only in a count, as in ``F[0,100] p``: draw their inner states as one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from tltlc.automaton.fspa import Fspa, Guard, Mark, State
from tltlc.core.record import EMPTY, record, replace
from tltlc.logic.text.counts import number_range

LEAST_FOLDED = 3
"""A run is folded if it has at least this many inner states.

The inner states are all except the first and the last one.
"""


class EdgeLabel(NamedTuple):
    """The guard of an edge, and the sets of the Rabin pairs that contain the edge (none over finite traces)."""

    guard: Guard
    marks: tuple[Mark, ...]


@record
class DrawnEdge:
    """An edge of a drawing; ``source`` and ``target`` are the numbers of its states."""

    source: int
    target: int
    label: EdgeLabel


@record
class Drawing:
    """The states and edges that are drawn, in the automaton's order.

    A folded run is a path of states that differ only in a count; its inner states are all except
    the first and the last. Only the first inner state is in ``states``, and its edge leads to the
    last state of the run. ``folded`` maps the number of this inner state to all inner states of the
    run.
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
    """Return a drawing in which the inner states of each long run are folded into one.

    A run is a path of states that differ only in a count, and its inner states are all except the
    first and the last. A run has these properties:

    - All edges of the path have the same label, and the last state has an edge with this label, too.
    - Its states have the same verdict and the same acceptance. Apart from the edges with this
      label, the edges of its states have the same labels and targets.
    - No edge leads to an inner state, except the edge along the path.
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
    """Return the inner states of each run that is folded, each with its edge to the next state of the run.

    :func:`fold_runs` says what a run and its inner states are.
    """
    outgoing: list[list[DrawnEdge]] = [[] for _ in states]
    entering: list[list[DrawnEdge]] = [[] for _ in states]
    for edge in edges:
        outgoing[edge.source].append(edge)
        entering[edge.target].append(edge)
    along: dict[int, DrawnEdge] = {}
    for state in range(1, len(states)):  # State 0 is no inner state, because traces also start there.
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
    """Return the edge that follows ``edge`` in a run (:func:`fold_runs`).

    Return None if the two states of ``edge`` do not belong to a run. ``outgoing`` has the edges that
    leave each state.
    """
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


def distance_range(first: int | None, last: int | None, none: str = "∞") -> str:
    """Return one text for the distances of the first and the last state of a run: ``12…1``.

    ``none`` is the text for traps, whose distance is None. The states of a run have the same
    verdict, so all or none of them are traps.
    """
    return none if first is None or last is None else number_range(first, last)
