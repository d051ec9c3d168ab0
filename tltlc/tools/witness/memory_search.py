"""Search traces of automata with registers: run the automata on inputs, and try sequence after sequence.

Which values registers can have depends on all samples before, so a path through an automaton need not
be a trace. This search takes only steps that a monitor takes. Its work is bounded: it may find no
trace although there is one.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from heapq import heappop, heappush
from itertools import islice
from typing import TYPE_CHECKING, Final, NamedTuple, Union

from tltlc.automaton.fspa import Fspa
from tltlc.core.record import record
from tltlc.monitor import MonitorError
from tltlc.monitor.exclusive import check_exclusive
from tltlc.monitor.guards import holds
from tltlc.monitor.samples import Samples
from tltlc.tools.witness.step_lengths import (
    length_names,
    length_of,
    lengths_to_try,
    letter_with_length,
    sample_with_length,
)

if TYPE_CHECKING:
    from tltlc.automaton.compare import Letter
    from tltlc.monitor.samples import SampleValues
    from tltlc.monitor.traces import TraceSample

    TraceInput = Union[TraceSample, Letter]
    """A sample, or the names of the atoms that hold."""

SINGLE_STEPS: Final = 8_000
"""The most steps that the search takes one by one, in all sequences together."""
HELD_STEPS: Final = 60_000
"""The most steps that the search takes after that, while it repeats each input until something changes."""
_SMALL: Final = 16
"""Up to twice as many atoms and registers have the size 1."""
_FINAL: Final = ("satisfied", "violated")
_FAR: Final = 1_000_000


class Configuration(NamedTuple):
    """The state and the values of the registers of each automaton."""

    states: tuple[int, ...]
    registers: tuple[tuple[float, ...], ...]


class Step(NamedTuple):
    """The edge that each automaton takes, the atoms that hold, their values in each automaton, and what follows."""

    edges: tuple[int, ...]
    letter: Letter
    after: Configuration
    values: tuple[tuple[float, ...], ...]


@record
class Position:
    """Where a trace has led: after the trace to ``parent``, the input with the index ``number`` came ``times`` times.

    ``edges`` has the edge that each automaton took at the last step, as its index.
    """

    parent: Position | None
    number: int
    times: int
    edges: tuple[int, ...]
    configuration: Configuration

    def trace(self) -> tuple[int, ...]:
        """Return the indices of the inputs of the whole trace."""
        runs: list[tuple[int, int]] = []
        position: Position | None = self
        while position is not None and position.parent is not None:
            runs.append((position.number, position.times))
            position = position.parent
        return tuple(number for number, times in reversed(runs) for _ in range(times))


class MemorySearch:
    """Runs one or more automata together on traces of ``inputs``.

    The inputs are samples with a value for every signal of the automata, or letters. A letter names
    the atoms that hold; those that follow from others are computed. ``names`` has the names of the
    atoms of each automaton in letters, by default their own. No two atoms of a group in ``exclusive``
    may hold together. If the clock varies, each input is tried with some lengths of a step, which are
    never all. ``has_ended`` is true once all traces over the inputs have been tried, and ``tried_all``
    if these are all traces with this truth of atoms. ``size`` is at least 1; the search takes fewer steps
    for larger automata, since each of their steps takes longer.
    """

    def __init__(
        self,
        automata: Sequence[Fspa],
        inputs: Sequence[TraceInput],
        names: Sequence[Sequence[str]] | None = None,
        exclusive: Sequence[Collection[str]] = (),
    ) -> None:
        self._varies = any(fspa.clock_varies for fspa in automata)
        self.inputs = list(_with_lengths(inputs, automata) if self._varies else inputs)
        self.tried_all = self.has_ended = False
        items = max((len(fspa.atoms) + len(fspa.registers) for fspa in automata), default=0)
        self.size = max(1, items // _SMALL)
        self._numbers = range(len(self.inputs))
        self._added: dict[object, int] = {}
        self._automata = tuple(automata)
        self._names = names or [[atom.name for atom in fspa.atoms] for fspa in automata]
        self._exclusive = exclusive
        self._values = tuple(Samples(fspa, None, []) for fspa in automata)
        self._leaving = tuple(_leaving(fspa) for fspa in automata)

    def add(self, given: TraceInput) -> list[int]:
        """Add an input for :meth:`step` alone, and return its numbers: one for each length of a step."""
        return list(map(self.add_one, _with_lengths((given,), self._automata) if self._varies else (given,)))

    def add_one(self, given: TraceInput) -> int:
        """Add an input for :meth:`step` alone, with its length if the clock varies, and return its number."""
        key = frozenset(given.items()) if isinstance(given, Mapping) else given
        if key not in self._added:
            self._added[key] = len(self.inputs)
            self.inputs.append(given)
        return self._added[key]

    def positions(self) -> Iterator[Position]:
        """Yield the ends of traces: at first in the order of their lengths, until the work is done.

        If that leaves traces untried, also yield traces that repeat each input until the truth of an
        atom or the state of an automaton changes.
        """
        yield from self.short_positions(SINGLE_STEPS // self.size)
        if not self.has_ended:
            yield from self.held_positions(HELD_STEPS // self.size)

    def short_positions(self, most: int) -> Iterator[Position]:
        """Yield the ends of traces in the order of their lengths, at most ``most``."""
        for number, position in enumerate(self._single_steps(), start=1):
            yield position
            if number == most:
                return
        self.has_ended, self.tried_all = True, not self._varies

    def held_positions(self, most: int) -> Iterator[Position]:
        """Yield the ends of traces that repeat each input until something changes, at most ``most``."""
        yield from islice(self._held_steps(), most)

    def first_positions(self) -> Iterator[Position]:
        """Yield the ends of all traces with one step."""
        start = self.start()
        for number in self._numbers:
            if step := self.step(start.configuration, number):
                yield Position(start, number, 1, step.edges, step.after)

    def shorter(self, end: Position, is_end: Callable[[tuple[int, ...]], bool]) -> Position:
        """Return the end of a trace without those inputs, each with its repetitions, that are not needed.

        ``is_end`` says whether a trace may end with these edges of the automata.
        """
        kept: list[tuple[int, int]] = [(end.number, end.times)]
        before = end.parent
        while before is not None and before.parent is not None:
            other = self._after(before.parent, kept, is_end)
            if other is None:
                kept = [(before.number, before.times), *kept]
            else:
                end = other
            before = before.parent
        return end

    def _after(
        self, position: Position, runs: Iterable[tuple[int, int]], is_end: Callable[[tuple[int, ...]], bool]
    ) -> Position | None:
        """Return where a trace from a position may end, with inputs that each come so often; None if it may not."""
        for number, times in runs:
            before = position
            for count in range(1, times + 1):
                step = self.step(position.configuration, number)
                if step is None:
                    return None
                position = Position(before, number, count, step.edges, step.after)
                if is_end(step.edges):
                    return position
        return None

    def letters(self, position: Position) -> tuple[Letter, ...]:
        """Return the names of the atoms that hold at each step of the trace to a position."""
        configuration, letters = self.start().configuration, []
        for number in position.trace():
            step = self.step(configuration, number)
            assert step is not None, "the search has taken this step"
            letters.append(step.letter)
            configuration = step.after
        return tuple(letters)

    def start(self) -> Position:
        """Return the position before the first step."""
        states = tuple(0 for _ in self._automata)
        return Position(None, -1, 0, (), Configuration(states, tuple(values.initial for values in self._values)))

    def _single_steps(self) -> Iterator[Position]:
        start = self.start()
        seen, queue = {self._key(start.configuration)}, deque([start])
        while queue:
            before = queue.popleft()
            for number in self._numbers:
                step = self.step(before.configuration, number)
                if step is None:
                    continue
                position = Position(before, number, 1, step.edges, step.after)
                yield position
                key = self._key(step.after)
                if key not in seen:
                    seen.add(key)
                    queue.append(position)

    def _held_steps(self) -> Iterator[Position]:
        """Yield positions while inputs repeat; those nearest to acceptance are continued first."""
        start, count = self.start(), 0
        seen, heap = {self._key(start.configuration)}, [(0, count, start)]
        while heap:
            _, _, before = heappop(heap)
            holds = [self._held(before, number) for number in self._numbers]
            while holds:
                # All inputs repeat side by side, so that none uses up the work.
                for hold in list(holds):
                    position, is_turn = next(hold, (None, False))
                    if position is None:
                        holds.remove(hold)
                        continue
                    yield position
                    key = self._key(position.configuration)
                    if is_turn and key not in seen:
                        seen.add(key)
                        count += 1
                        heappush(heap, (self._distance(position.configuration), count, position))

    def _held(self, before: Position, number: int) -> Iterator[tuple[Position, bool]]:
        """Yield the positions while an input repeats, until something changes or nothing ever will.

        Each comes with whether another input may follow.
        """
        configuration, previous, times = before.configuration, None, 0
        while True:
            step = self.step(configuration, number)
            if step is None:
                return
            times += 1
            is_still = step.after == configuration or self._is_final(step.after)
            has_changed = previous is not None and (step.letter, step.after.states) != previous
            position = Position(before, number, times, step.edges, step.after)
            yield position, times == 1 or has_changed or is_still
            if has_changed or is_still:
                return
            configuration, previous = step.after, (step.letter, step.after.states)

    def _distance(self, configuration: Configuration) -> int:
        """Return the sum of the distances of all automata to acceptance; a large number in a trap."""
        pairs = zip(self._automata, configuration.states, strict=True)
        distances = [fspa.states[state].distance for fspa, state in pairs]
        return sum(_FAR if distance is None else distance for distance in distances)

    def step(self, before: Configuration, number: int) -> Step | None:
        """Return a step, or None if a monitor rejects the input."""
        edges, registers, atoms = [], [], []
        letter: set[str] = set()
        for index, fspa in enumerate(self._automata):
            try:
                values = self._sample_values(index, self.inputs[number], before.registers[index])
                check_exclusive(fspa, values.atoms, 1)
            except MonitorError:
                return None
            leaving = self._leaving[index][before.states[index]]
            edges.append(next(edge for edge in leaving if holds(fspa.edges[edge].guard, values.atoms)))
            letter.update(name for name, value in zip(self._names[index], values.atoms, strict=True) if value > 0.0)
            registers.append(values.registers)
            atoms.append(values.atoms)
        if any(len(letter.intersection(group)) > 1 for group in self._exclusive):
            return None
        if self._varies:
            letter.update(length_names(self.inputs[number]))
        states = tuple(fspa.edges[edge].target for fspa, edge in zip(self._automata, edges, strict=True))
        return Step(tuple(edges), frozenset(letter), Configuration(states, tuple(registers)), tuple(atoms))

    def _sample_values(self, index: int, given: TraceInput, registers: tuple[float, ...]) -> SampleValues:
        samples = self._values[index]
        if isinstance(given, Mapping):
            return samples.values(given, registers, 1)
        names = self._names[index]
        values = [1.0 if names[atom] in given else -1.0 for atom in samples.given]
        length = samples.step_length(length_of(given, self._automata[index]), 1)
        return samples.from_atoms(values, registers, length, 1)

    def _key(self, configuration: Configuration) -> object:
        """Return what two positions share if only one of them needs a continuation."""
        return configuration.states if self._is_final(configuration) else configuration

    def _is_final(self, configuration: Configuration) -> bool:
        pairs = zip(self._automata, configuration.states, strict=True)
        return all(fspa.states[state].verdict in _FINAL for fspa, state in pairs)


def _with_lengths(inputs: Iterable[TraceInput], automata: Sequence[Fspa]) -> Iterator[TraceInput]:
    lengths = lengths_to_try(automata)
    for given in inputs:
        for seconds in lengths:
            if isinstance(given, Mapping):
                yield sample_with_length(given, seconds)
            else:
                yield letter_with_length(given, seconds)


def _leaving(fspa: Fspa) -> list[list[int]]:
    leaving: list[list[int]] = [[] for _ in fspa.states]
    for index, edge in enumerate(fspa.edges):
        leaving[edge.source].append(index)
    return leaving
