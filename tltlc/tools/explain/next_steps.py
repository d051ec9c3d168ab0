"""Find the edges of an automaton that lead on, that is, make progress towards the goal."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Final

from tltlc.automaton.fspa import Edge, Fspa
from tltlc.automaton.work import OutOfWork

_MOST_WORK: Final = 500_000
"""The most steps of work in the comparison of states."""


def edges_leading_on(fspa: Fspa) -> tuple[int, ...]:
    """Return the indices of the edges that lead on; edges that need the fewest atoms come first.

    An edge leads on if its target has a smaller distance than its source. If a single step can meet
    two goals, meeting only one of them does not change the distance. So over finite traces, an edge
    between states of the same distance also leads on if the automaton accepts strictly more traces
    from the target than from the source.
    """
    closer, equally_far = [], []
    for index, edge in enumerate(fspa.edges):
        here, there = fspa.states[edge.source].distance, fspa.states[edge.target].distance
        if here and there is not None:
            if there < here:
                closer.append(index)
            elif there == here and edge.source != edge.target:
                equally_far.append(index)
    leading = [*closer, *(_edges_with_less_left(fspa, equally_far) if fspa.semantics == "finite" else ())]
    return tuple(sorted(leading, key=lambda index: (_least_atoms(fspa.edges[index]), index)))


def _edges_with_less_left(fspa: Fspa, edges: Sequence[int]) -> Iterable[int]:
    """Return those of ``edges`` from whose target strictly more traces are accepted than from the source.

    ``edges`` and the result are indices. The result is empty if the comparison takes too much work.
    """
    if not edges:
        return ()
    from tltlc.automaton.compare import state_inclusion

    has_less_left = state_inclusion(fspa, _MOST_WORK)
    try:
        return [index for index in edges if has_less_left(fspa.edges[index].source, fspa.edges[index].target)]
    except OutOfWork:
        return ()


def _least_atoms(edge: Edge) -> int:
    """Return the smallest number of atoms that must hold for an edge to be taken."""
    return min(sum(holds for _, holds in prime) for prime in edge.guard.primes)
