"""Search traces of automata with registers: run the automata on samples, and try sequence after sequence.

Which values registers can have depends on all samples before, so a path through an automaton need not
be a trace. This search takes only steps that a monitor takes. Its work is bounded: it may find no
trace although there is one.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Sequence
from itertools import islice
from typing import TYPE_CHECKING, Final, NamedTuple

from tltlc.automaton.fspa import Fspa
from tltlc.core.record import record
from tltlc.monitor import MonitorError
from tltlc.monitor.guards import holds
from tltlc.monitor.samples import Samples, check_exclusive

if TYPE_CHECKING:
    from tltlc.monitor.traces import TraceSample

_SINGLE_STEPS: Final = 8_000
"""The most steps that the search takes one by one, in all sequences together."""
_HELD_STEPS: Final = 40_000
"""The most steps that the search takes after that, while it repeats each sample until something changes."""
_FINAL: Final = ("satisfied", "violated")


class _Configuration(NamedTuple):
    """The state and the values of the registers of each automaton."""

    states: tuple[int, ...]
    registers: tuple[tuple[float, ...], ...]


class _Step(NamedTuple):
    edges: tuple[int, ...]
    truth: tuple[tuple[bool, ...], ...]
    after: _Configuration


@record
class Position:
    """Where a trace has led: after the trace to ``parent``, the sample with the index ``sample`` came ``times`` times.

    ``edges`` has the edge that each automaton took at the last step, as its index.
    """

    parent: Position | None
    sample: int
    times: int
    edges: tuple[int, ...]
    configuration: _Configuration

    def trace(self) -> tuple[int, ...]:
        """Return the indices of the samples of the whole trace."""
        runs: list[tuple[int, int]] = []
        position: Position | None = self
        while position is not None and position.parent is not None:
            runs.append((position.sample, position.times))
            position = position.parent
        return tuple(sample for sample, times in reversed(runs) for _ in range(times))


class MemorySearch:
    """Runs one or more automata together on traces over a list of samples.

    Each of ``samples`` has a value for every signal of the automata.
    """

    def __init__(self, automata: Sequence[Fspa], samples: Sequence[TraceSample]) -> None:
        self.samples = tuple(samples)
        self._automata = tuple(automata)
        self._values = tuple(Samples(fspa, None, []) for fspa in automata)
        self._leaving = tuple(_leaving(fspa) for fspa in automata)

    def positions(self) -> Iterator[Position]:
        """Yield the ends of traces: at first in the order of their lengths, until the work is done.

        If that leaves traces untried, also yield traces that repeat each sample until the truth of an
        atom or the state of an automaton changes.
        """
        count = 0
        for count, position in enumerate(self._single_steps(), start=1):
            yield position
            if count == _SINGLE_STEPS:
                break
        if count == _SINGLE_STEPS:
            yield from islice(self._held_steps(), _HELD_STEPS)

    def first_positions(self) -> Iterator[Position]:
        """Yield the ends of all traces with one sample."""
        start = self._start()
        for sample in range(len(self.samples)):
            if step := self._step(start.configuration, sample):
                yield Position(start, sample, 1, step.edges, step.after)

    def _start(self) -> Position:
        states = tuple(0 for _ in self._automata)
        return Position(None, -1, 0, (), _Configuration(states, tuple(values.initial for values in self._values)))

    def _single_steps(self) -> Iterator[Position]:
        start = self._start()
        seen, queue = {self._key(start.configuration)}, deque([start])
        while queue:
            before = queue.popleft()
            for sample in range(len(self.samples)):
                step = self._step(before.configuration, sample)
                if step is None:
                    continue
                position = Position(before, sample, 1, step.edges, step.after)
                yield position
                key = self._key(step.after)
                if key not in seen:
                    seen.add(key)
                    queue.append(position)

    def _held_steps(self) -> Iterator[Position]:
        start = self._start()
        seen, queue = {self._key(start.configuration)}, deque([start])
        while queue:
            before = queue.popleft()
            for sample in range(len(self.samples)):
                for position, is_turn in self._held(before, sample):
                    yield position
                    key = self._key(position.configuration)
                    if is_turn and key not in seen:
                        seen.add(key)
                        queue.append(position)

    def _held(self, before: Position, sample: int) -> Iterator[tuple[Position, bool]]:
        """Yield the positions while a sample repeats, until something changes or nothing ever will.

        Each comes with whether another sample may follow.
        """
        configuration, previous, times = before.configuration, None, 0
        while True:
            step = self._step(configuration, sample)
            if step is None:
                return
            times += 1
            is_still = step.after == configuration
            has_changed = previous is not None and (step.truth, step.after.states) != previous
            position = Position(before, sample, times, step.edges, step.after)
            yield position, times == 1 or has_changed or is_still
            if has_changed or is_still:
                return
            configuration, previous = step.after, (step.truth, step.after.states)

    def _step(self, before: _Configuration, sample: int) -> _Step | None:
        """Return a step, or None if a monitor rejects the sample."""
        edges, truths, registers = [], [], []
        for number, fspa in enumerate(self._automata):
            try:
                values = self._values[number].values(self.samples[sample], before.registers[number], 1)
                check_exclusive(fspa, values.atoms, 1)
            except MonitorError:
                return None
            leaving = self._leaving[number][before.states[number]]
            edges.append(next(edge for edge in leaving if holds(fspa.edges[edge].guard, values.atoms)))
            truths.append(tuple([value > 0.0 for value in values.atoms]))
            registers.append(values.registers)
        states = tuple(fspa.edges[edge].target for fspa, edge in zip(self._automata, edges, strict=True))
        return _Step(tuple(edges), tuple(truths), _Configuration(states, tuple(registers)))

    def _key(self, configuration: _Configuration) -> object:
        """Return what two positions share if only one of them needs a continuation."""
        pairs = zip(self._automata, configuration.states, strict=True)
        is_final = all(fspa.states[state].verdict in _FINAL for fspa, state in pairs)
        return configuration.states if is_final else configuration


def _leaving(fspa: Fspa) -> list[list[int]]:
    leaving: list[list[int]] = [[] for _ in fspa.states]
    for index, edge in enumerate(fspa.edges):
        leaving[edge.source].append(index)
    return leaving
