"""What leads on from a state: nearer to the goal, or to where less is left to be done."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Final

from tltlc.automaton.fspa import Edge, Fspa
from tltlc.automaton.infinite.work import OutOfWork

_MOST_WORK: Final = 500_000
"""Steps that comparing states may take."""


def leading_on(fspa: Fspa) -> tuple[int, ...]:
    """The edges, by their indices, that lead on; those that ask for few atoms at once come first.

    An edge does if it leads to a smaller distance.  Two goals that may be met at once are as far away as one of them:
    over finite traces one does, too, if whatever mends its source mends its target, and not the other way round.
    """
    nearer, level = [], []
    for index, edge in enumerate(fspa.edges):
        here, there = fspa.states[edge.source].distance, fspa.states[edge.target].distance
        if here and there is not None:
            if there < here:
                nearer.append(index)
            elif there == here and edge.source != edge.target:
                level.append(index)
    found = [*nearer, *(_to_less(fspa, level) if fspa.semantics == "finite" else ())]
    return tuple(sorted(found, key=lambda index: (_at_once(fspa.edges[index]), index)))


def _to_less(fspa: Fspa, edges: Sequence[int]) -> Iterable[int]:
    """Those of the edges after which less is left; none where comparing takes too long."""
    if not edges:
        return ()
    from tltlc.automaton.compare import less_is_left

    is_left = less_is_left(fspa, _MOST_WORK)
    try:
        return [index for index in edges if is_left(fspa.edges[index].source, fspa.edges[index].target)]
    except OutOfWork:
        return ()


def _at_once(edge: Edge) -> int:
    """How many atoms have to hold for an edge to be taken, at least."""
    return min(sum(holds for _, holds in prime) for prime in edge.guard.primes)
