"""Find the edges of an automaton that samples can take, each with a letter and a sample."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from functools import cached_property
from typing import TYPE_CHECKING

from tltlc.automaton.fspa import Fspa, Implicant
from tltlc.core.record import record
from tltlc.tools.witness.samples import Realiser, Sample, UnsatisfiedLiterals

if TYPE_CHECKING:
    from tltlc.automaton.compare import Letter

_MOST_PRIMES = 500
"""The most primes of a guard that are tried."""


@record
class SampledEdge:
    """An edge, by index, with a sample that takes it.

    ``prime`` is the prime of the edge's guard that the sample satisfies.
    """

    edge: int
    prime: Implicant
    letter: Letter
    sample: Sample


class Moves:
    """The possible moves in each state of an automaton. Edges are examined on demand."""

    def __init__(self, fspa: Fspa) -> None:
        self.fspa = fspa
        self.obstacles: dict[int, tuple[UnsatisfiedLiterals, ...]] = {}
        """For each examined edge that no sample was found to take, the obstacles."""
        self._realiser = Realiser(fspa)
        self._known: dict[int, SampledEdge | None] = {}

    @cached_property
    def leaving(self) -> tuple[tuple[int, ...], ...]:
        """For each state, the indices of the edges that leave it."""
        leaving: list[list[int]] = [[] for _ in self.fspa.states]
        for index, edge in enumerate(self.fspa.edges):
            leaving[edge.source].append(index)
        return tuple(map(tuple, leaving))

    def move(self, edge: int) -> SampledEdge | None:
        """Return the simplest sample that takes an edge, or None.

        It satisfies the first prime of the guard, in order, for which a sample is found.
        """
        if edge not in self._known:
            self._known[edge] = self._found(edge)
        return self._known[edge]

    def _found(self, edge: int) -> SampledEdge | None:
        obstacles: list[UnsatisfiedLiterals] = []
        for prime in self.fspa.edges[edge].guard.primes[:_MOST_PRIMES]:
            sample = self._realiser.literals(prime)
            if not isinstance(sample, UnsatisfiedLiterals):
                return SampledEdge(edge, prime, self._realiser.letter_of(sample), sample)
            obstacles.append(sample)
        self.obstacles[edge] = tuple(dict.fromkeys(obstacles))
        return None

    def way(self, start: int, is_last: Callable[[int], bool]) -> tuple[SampledEdge, ...] | None:
        """Return the moves of a shortest path from a state to a wanted last edge, or None.

        ``is_last`` decides by index which edges are wanted. The path has at least one move.
        """
        before: dict[int, tuple[int, SampledEdge] | None] = {start: None}
        queue = deque([start])
        while queue:
            state = queue.popleft()
            # Wanted edges are checked before edges that only lead on.
            for edge in self.leaving[state]:
                if is_last(edge) and (move := self.move(edge)) is not None:
                    return (*_moves_to(state, before), move)
            for edge in self.leaving[state]:
                target = self.fspa.edges[edge].target
                if target not in before and (move := self.move(edge)) is not None:
                    before[target] = state, move
                    queue.append(target)
        return None


def _moves_to(state: int, before: dict[int, tuple[int, SampledEdge] | None]) -> tuple[SampledEdge, ...]:
    moves: list[SampledEdge] = []
    while (step := before[state]) is not None:
        state, move = step
        moves.append(move)
    return tuple(reversed(moves))
