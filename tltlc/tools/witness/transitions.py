"""The edges of an automaton that samples can take: each with the letter and the sample that take it."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from functools import cached_property
from typing import TYPE_CHECKING

from tltlc.automaton.fspa import Fspa, Implicant
from tltlc.core.record import record
from tltlc.tools.witness.samples import Obstacle, Realiser, Sample

if TYPE_CHECKING:
    from tltlc.automaton.compare import Letter

_MOST_PRIMES = 500
"""Of a guard, which are tried."""


@record
class Move:
    """An edge, by its index, taken by a sample; ``prime`` is what of the letter makes it so."""

    edge: int
    prime: Implicant
    letter: Letter
    sample: Sample


class Moves:
    """What can be done in each state of an automaton; edges are looked at when they are asked for."""

    def __init__(self, fspa: Fspa) -> None:
        self.fspa = fspa
        self.obstacles: dict[int, tuple[Obstacle, ...]] = {}
        """Of each edge that was asked for and that no sample was found to take, what stands in the way."""
        self._realiser = Realiser(fspa)
        self._known: dict[int, Move | None] = {}

    @cached_property
    def leaving(self) -> tuple[tuple[int, ...], ...]:
        """Of each state the edges that leave it, by their indices."""
        found: list[list[int]] = [[] for _ in self.fspa.states]
        for index, edge in enumerate(self.fspa.edges):
            found[edge.source].append(index)
        return tuple(map(tuple, found))

    def move(self, edge: int) -> Move | None:
        """The simplest sample that takes an edge: by its first prime, in order, for which there is one."""
        if edge not in self._known:
            self._known[edge] = self._found(edge)
        return self._known[edge]

    def _found(self, edge: int) -> Move | None:
        obstacles: list[Obstacle] = []
        for prime in self.fspa.edges[edge].guard.primes[:_MOST_PRIMES]:
            sample = self._realiser.literals(prime)
            if not isinstance(sample, Obstacle):
                return Move(edge, prime, self._realiser.letter_of(sample), sample)
            obstacles.append(sample)
        self.obstacles[edge] = tuple(dict.fromkeys(obstacles))
        return None

    def way(self, start: int, is_last: Callable[[int], bool]) -> tuple[Move, ...] | None:
        """The moves of a shortest way from a state whose last edge, by its index, is wanted; at least one."""
        before: dict[int, tuple[int, Move] | None] = {start: None}
        queue = deque([start])
        while queue:
            state = queue.popleft()
            # An edge that is wanted is taken before those that only lead on.
            for edge in self.leaving[state]:
                if is_last(edge) and (move := self.move(edge)) is not None:
                    return (*_moves_to(state, before), move)
            for edge in self.leaving[state]:
                target = self.fspa.edges[edge].target
                if target not in before and (move := self.move(edge)) is not None:
                    before[target] = state, move
                    queue.append(target)
        return None


def _moves_to(state: int, before: dict[int, tuple[int, Move] | None]) -> tuple[Move, ...]:
    found: list[Move] = []
    while (step := before[state]) is not None:
        state, move = step
        found.append(move)
    return tuple(reversed(found))
