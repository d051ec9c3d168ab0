"""Read recorded traces as letters: the atoms that hold at each sample."""

from __future__ import annotations

import io
from collections.abc import Callable, Iterator, Sequence
from math import nan

from tltlc.automaton.compare import Letter
from tltlc.core.record import record
from tltlc.core.source import SourceKind
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.monitor.samples import MonitorError, Samples, check_exclusive
from tltlc.monitor.traces import TraceSample, in_trace, read_trace
from tltlc.resolve.spec import Signal
from tltlc.tools.mine.evidence import LabelledTrace
from tltlc.tools.mine.vocabulary import MiningVocabulary

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
    cache: dict[tuple[float, ...], Letter] = {}
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
    file: TraceFile, samples: Samples, vocabulary: MiningVocabulary, cache: dict[tuple[float, ...], Letter]
) -> Iterator[Letter]:
    """Yield, for each sample of a trace, its letter: the set of the atoms that hold.

    ``cache`` maps samples to letters, because samples often repeat. New samples are added to it.
    """
    reader = vocabulary.reader
    names = [signal.name for signal in reader.signals]
    for number, row in enumerate(_rows(file, reader.signals, reader.clock_s, reader.clock_varies), start=1):
        sample = tuple([row.get(name, nan) for name in names])
        letter = cache.get(sample)
        if letter is None:
            values = samples.atom_values(row, number)
            check_exclusive(reader, values, number)
            letter = frozenset(atom.name for atom, value in zip(reader.atoms, values, strict=True) if value > 0.0)
            cache[sample] = letter
        yield letter
