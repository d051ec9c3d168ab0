"""Find the edges that lead on from a state: closer to the goal, or to where less is left to do."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Final

from tltlc.automaton.fspa import Edge, Fspa
from tltlc.automaton.work import OutOfWork

_MOST_WORK: Final = 500_000
"""The most steps that the comparison of states may take."""


def leading_on(fspa: Fspa) -> tuple[int, ...]:
    """Return the indices of the edges that lead on, edges that need the fewest atoms at once first.

    An edge leads on if it leads to a smaller distance. That is too strict where one step may meet
    two goals, because two such goals are as far away as one. So over finite traces, an edge between
    states of the same distance also leads on, if every trace that succeeds from its source also
    succeeds from its target, but not the other way round.
    """
    nearer, level = [], []
    for index, edge in enumerate(fspa.edges):
        here, there = fspa.states[edge.source].distance, fspa.states[edge.target].distance
        if here and there is not None:
            if there < here:
                nearer.append(index)
            elif there == here and edge.source != edge.target:
                level.append(index)
    leading = [*nearer, *(_to_less(fspa, level) if fspa.semantics == "finite" else ())]
    return tuple(sorted(leading, key=lambda index: (_at_once(fspa.edges[index]), index)))


def _to_less(fspa: Fspa, edges: Sequence[int]) -> Iterable[int]:
    """Return the edges after which less is left to do; empty if the comparison takes too long."""
    if not edges:
        return ()
    from tltlc.automaton.compare import less_is_left

    is_left = less_is_left(fspa, _MOST_WORK)
    try:
        return [index for index in edges if is_left(fspa.edges[index].source, fspa.edges[index].target)]
    except OutOfWork:
        return ()


def _at_once(edge: Edge) -> int:
    """Return the smallest number of atoms that must hold to take an edge."""
    return min(sum(holds for _, holds in prime) for prime in edge.guard.primes)
