"""Read recorded traces as letters: the atoms that hold at each sample."""

from __future__ import annotations

import io
from collections.abc import Callable, Iterator, Sequence
from math import nan

from tltlc.automaton.compare import Letter
from tltlc.automaton.fspa import Fspa
from tltlc.core.record import record
from tltlc.core.source import SourceKind
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.monitor.errors import MonitorError
from tltlc.monitor.exclusive import check_exclusive
from tltlc.monitor.samples import STEP_LENGTH, Samples
from tltlc.monitor.traces import TraceSample, in_trace, read_trace
from tltlc.resolve.spec import Signal
from tltlc.tools.mine.evidence import LabelledTrace
from tltlc.tools.mine.vocabulary import MiningVocabulary
from tltlc.tools.witness.blocks import given_values
from tltlc.tools.witness.step_lengths import length_names, length_of

ProgressCallback = Callable[[str], None]
"""A callback that gets a progress message in words, at least once for each file."""


def ignore_progress(_: str) -> None:
    """Do nothing: the default for callers that show no progress."""


@record
class TraceFile:
    """A trace file: its name in messages, its content and its kind of source."""

    name: str
    data: bytes
    kind: SourceKind = "file"


def read_traces(
    files: Sequence[TraceFile], vocabulary: MiningVocabulary, report_progress: ProgressCallback = ignore_progress
) -> tuple[tuple[LabelledTrace, ...], tuple[Diagnostic, ...]]:
    """Return the traces in the files, and warnings about values that were clamped to their range.

    Raises:
        TltlError: the errors of :func:`tltlc.monitor.traces.read_trace` and of the monitor, with the
            name of the trace.
    """
    notices: list[Diagnostic] = []
    warnings: list[Diagnostic] = []
    samples = Samples(vocabulary.reader, None, notices)
    cache: dict[tuple[float, ...], tuple[Letter, tuple[float, ...]]] = {}
    traces = []
    for file in files:
        report_progress(f"reading {file.name}")
        try:
            traces.append(LabelledTrace(file.name, tuple(_letters(file, samples, vocabulary, cache))))
        except MonitorError as error:
            raise MonitorError(in_trace(file.name, error.diagnostics)) from None
        warnings += in_trace(file.name, notices)
        notices.clear()
    return tuple(traces), tuple(warnings)


def check_trace(file: TraceFile) -> None:
    """Raise the errors that :func:`tltlc.monitor.traces.read_trace` raises for a trace; return nothing."""
    for _ in _rows(file, ()):
        pass


def _rows(
    file: TraceFile, signals: Sequence[Signal], clock_s: float | None = None, clock_varies: bool = False
) -> Iterator[TraceSample]:
    return read_trace(io.BytesIO(file.data), file.name, signals, clock_s, file.kind, clock_varies=clock_varies)


def _letters(
    file: TraceFile,
    samples: Samples,
    vocabulary: MiningVocabulary,
    cache: dict[tuple[float, ...], tuple[Letter, tuple[float, ...]]],
) -> Iterator[Letter]:
    """Yield, for each sample of a trace, its letter: the set of the atoms that hold.

    ``cache`` maps samples, with what is remembered before them, to letters, because samples often
    repeat. New samples are added to it.
    """
    reader = vocabulary.reader
    names = [signal.name for signal in reader.signals]
    registers = samples.initial
    for number, row in enumerate(_rows(file, reader.signals, reader.clock_s, reader.clock_varies), start=1):
        sample = (*[row.get(name, nan) for name in (*names, STEP_LENGTH)], *registers)
        known = cache.get(sample)
        if known is None:
            values = samples.values(row, registers, number)
            check_exclusive(reader, values.atoms, number)
            known = cache[sample] = _letter(reader, values.atoms) | length_names(row), values.registers
        letter, registers = known
        yield letter


def consistent(letters: Sequence[Letter], reader: Fspa) -> tuple[Letter, ...]:
    """Return a trace in which the atoms that follow from others, such as ``times(seen) > 3``, do follow.

    The other atoms are those of ``letters``. ``reader`` is an automaton with all atoms.
    """
    if not reader.registers:
        return tuple(letters)
    samples = Samples(reader, None, [])
    registers = samples.initial
    result = []
    for letter in letters:
        length = samples.step_length(length_of(letter, reader), 1)
        values = samples.from_atoms(given_values(reader, letter), registers, length, 1)
        registers = values.registers
        result.append(_letter(reader, values.atoms) | length_names(letter))
    return tuple(result)


def _letter(reader: Fspa, values: Sequence[float]) -> Letter:
    return frozenset(atom.name for atom, value in zip(reader.atoms, values, strict=True) if value > 0.0)
