"""Find samples at which an automaton takes its edges."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from functools import cached_property
from typing import TYPE_CHECKING

from tltlc.automaton.fspa import Fspa, Implicant
from tltlc.core.record import record
from tltlc.tools.witness.samples import SampleFinder, UnsatisfiedLiterals
from tltlc.tools.witness.step_lengths import length_names, lengths_to_try, sample_with_length

if TYPE_CHECKING:
    from tltlc.automaton.compare import Letter
    from tltlc.monitor.traces import TraceSample
    from tltlc.tools.witness.memory_traces import MemoryTraces

_MOST_PRIMES = 500
"""The most prime implicants of a guard that are tried."""


@record
class SampledEdge:
    """A move: an edge, and a sample at which the automaton takes this edge.

    ``edge`` is the index of the edge in the automaton. ``prime`` is the prime implicant of its guard
    that the sample satisfies, and ``letter`` has the atoms that hold at the sample.
    """

    edge: int
    prime: Implicant
    letter: Letter
    sample: TraceSample


class Moves:
    """The moves of an automaton: edges with samples that take them, searched when needed."""

    def __init__(self, fspa: Fspa) -> None:
        self.fspa = fspa
        self.obstacles: dict[int, tuple[UnsatisfiedLiterals, ...]] = {}
        """Maps the index of each edge without a sample to the reasons why the search found none."""
        self._cache: dict[int, SampledEdge | None] = {}

    @cached_property
    def traces(self) -> MemoryTraces:
        """The traces of an automaton with registers."""
        from tltlc.tools.witness.memory_traces import MemoryTraces

        return MemoryTraces(self.fspa)

    @cached_property
    def _finder(self) -> SampleFinder:
        return SampleFinder(self.fspa)

    @cached_property
    def leaving(self) -> tuple[tuple[int, ...], ...]:
        """The indices of the edges that leave each state."""
        leaving: list[list[int]] = [[] for _ in self.fspa.states]
        for index, edge in enumerate(self.fspa.edges):
            leaving[edge.source].append(index)
        return tuple(map(tuple, leaving))

    def move(self, edge: int) -> SampledEdge | None:
        """Return the edge with the index ``edge`` and a sample that takes it; None if no sample is found.

        The prime implicants of the guard are tried in order, until a sample is found for one. The
        automaton has no registers.
        """
        if edge not in self._cache:
            self._cache[edge] = self._search(edge)
        return self._cache[edge]

    def _search(self, edge: int) -> SampledEdge | None:
        obstacles: list[UnsatisfiedLiterals] = []
        for prime in self.fspa.edges[edge].guard.primes[:_MOST_PRIMES]:
            sample = self._finder.sample_for_literals(prime)
            if not isinstance(sample, UnsatisfiedLiterals):
                letter = self._finder.letter_of(sample)
                if self.fspa.clock_varies:
                    sample = sample_with_length(sample, *lengths_to_try((self.fspa,)))
                return SampledEdge(edge, prime, letter | length_names(sample), sample)
            obstacles.append(sample)
        self.obstacles[edge] = tuple(dict.fromkeys(obstacles))
        return None

    def shortest_path(self, start: int, is_last: Callable[[int], bool]) -> tuple[SampledEdge, ...] | None:
        """Return the moves of a shortest path that begins in the state ``start`` and ends with a certain edge.

        ``is_last`` gets the index of an edge, and says whether the path may end with this edge. The
        path has at least one move. Return None if there is no such path with samples. With registers,
        the path begins in state 0, and need not be a shortest one.
        """
        if self.fspa.registers:
            assert start == 0, "registers remember how a state was reached"
            return self.traces.trace_to(is_last)
        predecessors: dict[int, tuple[int, SampledEdge] | None] = {start: None}
        queue = deque([start])
        while queue:
            state = queue.popleft()
            # Check the edges that can end the path first.
            for edge in self.leaving[state]:
                if is_last(edge) and (move := self.move(edge)) is not None:
                    return (*_moves_to(state, predecessors), move)
            for edge in self.leaving[state]:
                target = self.fspa.edges[edge].target
                if target not in predecessors and (move := self.move(edge)) is not None:
                    predecessors[target] = state, move
                    queue.append(target)
        return None


def _moves_to(state: int, predecessors: dict[int, tuple[int, SampledEdge] | None]) -> tuple[SampledEdge, ...]:
    moves: list[SampledEdge] = []
    while (step := predecessors[state]) is not None:
        state, move = step
        moves.append(move)
    return tuple(reversed(moves))
