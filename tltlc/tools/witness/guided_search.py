"""Search traces of automata with registers towards some of their edges: try what the guards on the way ask for.

An automaton with many atoms has too many inputs to try all sequences of them. This search takes its
inputs from the guards of the edges that lead on. It tries the quiet input, at which as few atoms hold as
possible, in each state first. Each input repeats until something changes, so that times pass.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Iterator
from heapq import heappop, heappush
from itertools import count, islice
from typing import TYPE_CHECKING, Final, NamedTuple, Protocol

from tltlc.tools.witness.memory_search import Position

if TYPE_CHECKING:
    from tltlc.tools.witness.memory_search import MemorySearch


class Aim(Protocol):
    """What a search is to find."""

    def rank(self, states: tuple[int, ...]) -> int | None:
        """Return how far the states of the automata are from the aim; None if it cannot be reached from there."""
        ...

    def lack(self, states: tuple[int, ...], values: tuple[tuple[float, ...], ...]) -> float:
        """Return how much the memory lacks to come nearer, by the values of the atoms at the last sample; 0 or more."""
        ...

    def inputs(self, states: tuple[int, ...], values: tuple[tuple[float, ...], ...] | None) -> Iterable[int]:
        """Return the numbers of the inputs to try after a sample with these values of atoms, or at first."""
        ...


_MOST_VISITS: Final = 60
"""The most positions with the same states, and that lack about the same, from which the search goes on."""
_PER_VISIT: Final = 3
"""So many inputs cost as much as an earlier position with the same states that lacks about the same."""
_LONGEST_TURN: Final = 256
"""The most steps that an input repeats before other inputs have their turn."""
_PER_EDGE: Final = 4
"""So many inputs, or turns, cost as much as an edge that is still to be taken."""
_PER_LACK: Final = 4
"""So many inputs, or turns, cost as much as a value that lacks 1."""


class _Entry(NamedTuple):
    """What the search goes on with, the least entry first: the next ``turn`` steps of an input that repeats."""

    cost: float
    number: int
    turn: int
    rank: int
    moves: int
    steps: Iterator[tuple[Position, float]]


class GuidedSearch:
    """Yields positions of ``search``, those nearest to the aim first.

    Before the first sample, it is not known what is lacking. If a sample leaves everything as it was then, the
    search goes on from there only if it ``tries_again``, once it has nothing else to try.
    """

    def __init__(self, search: MemorySearch, aim: Aim, *, tries_again: bool = False) -> None:
        self._search, self._aim, self._tries_again = search, aim, tries_again
        self._heap: list[_Entry] = []
        self._numbers = count()
        self._visits: dict[Hashable, int] = {}
        self._seen: set[Hashable] = set()
        self._blind: set[Hashable] = set()
        self._again: dict[Hashable, tuple[Position, int, float, tuple[tuple[float, ...], ...] | None]] = {}

    def positions(self, starts: Iterable[Position]) -> Iterator[Position]:
        """Yield the ends of traces that go on from ``starts``, each one step after another or after a start."""
        for start in starts:
            self._visit(start, 0, 0.0, None)
        while self._heap or self._again:
            if not self._heap:
                again, self._again = self._again, {}
                self._blind.clear()
                for visit in again.values():
                    self._visit(*visit)
                continue
            entry = heappop(self._heap)
            done, lack = 0, 0.0
            for position, lack_then in islice(entry.steps, entry.turn):
                done, lack = done + 1, lack_then
                yield position
            if done == entry.turn:
                self._push(entry.rank, entry.moves + 1, lack, min(4 * entry.turn, _LONGEST_TURN), entry.steps)

    def _push(self, rank: int, moves: int, lack: float, turn: int, steps: Iterator[tuple[Position, float]]) -> None:
        cost = moves + _PER_EDGE * rank + _PER_LACK * lack
        heappush(self._heap, _Entry(cost, next(self._numbers), turn, rank, moves, steps))

    def _visit(self, position: Position, moves: int, lack: float, values: tuple[tuple[float, ...], ...] | None) -> None:
        """Try the inputs that the guards of the states ask for after a position."""
        states = position.configuration.states
        key = states, round(lack, 1)
        rank, visits = self._aim.rank(states), self._visits.get(key, 0)
        if rank is None or visits >= _MOST_VISITS or position.configuration in self._seen:
            return
        if position.configuration in self._blind:
            if values is not None and self._tries_again:
                self._again.setdefault(position.configuration, (position, moves, lack, values))
            return
        self._visits[key] = visits + 1
        (self._blind if values is None else self._seen).add(position.configuration)
        moves += 1 + visits * _PER_VISIT
        for number in dict.fromkeys(self._aim.inputs(states, values)):
            self._push(rank, moves, lack, 1, self._held(position, number, moves))

    def _held(self, before: Position, number: int, moves: int) -> Iterator[tuple[Position, float]]:
        """Yield the positions while an input repeats, until the states change or nothing ever will.

        Each comes with what it lacks. Other inputs follow after the first step, and where the truth of
        an atom or the states change.
        """
        configuration, times, letter = before.configuration, 0, None
        while (step := self._search.step(configuration, number)) is not None:
            times += 1
            position = Position(before, number, times, step.edges, step.after)
            lack = self._aim.lack(step.after.states, step.values)
            has_moved = step.after.states != before.configuration.states
            if has_moved or step.letter != letter:
                self._visit(position, moves, lack, step.values)
            yield position, lack
            if has_moved or step.after == configuration:
                return
            configuration, letter = step.after, step.letter
