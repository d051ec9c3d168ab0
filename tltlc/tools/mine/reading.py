"""Recorded traces as letters: the atoms that hold at each sample."""

from __future__ import annotations

import io
from collections.abc import Callable, Iterable, Iterator, Sequence
from math import nan

from tltlc.automaton.compare import Letter
from tltlc.core.record import record, replace
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.monitor.samples import MonitorError, Samples, check_exclusive
from tltlc.monitor.traces import Sample, read_trace
from tltlc.resolve.spec import Signal
from tltlc.tools.mine.evidence import Recorded
from tltlc.tools.mine.vocabulary import Words

Tell = Callable[[str], None]
"""Is told what is being done, at each file or more often."""


def silent(_: str) -> None:
    """Tells nobody."""


@record
class TraceFile:
    """A trace as it was found: what messages call it, and its bytes."""

    name: str
    data: bytes


def read(
    files: Sequence[TraceFile], words: Words, tell: Tell = silent
) -> tuple[tuple[Recorded, ...], tuple[Diagnostic, ...]]:
    """The traces, and warnings about values that had to be clamped, each given once.

    Raises:
        TltlError: what :func:`tltlc.monitor.traces.read_trace` raises, and a monitor, with the name of the trace.
    """
    notices: list[Diagnostic] = []
    said: list[Diagnostic] = []
    samples = Samples(words.reader, None, notices)
    known: dict[tuple[float, ...], Letter] = {}
    found = []
    for file in files:
        tell(f"reading {file.name}")
        try:
            found.append(Recorded(file.name, tuple(_letters(file, samples, words, known))))
        except MonitorError as error:
            raise MonitorError(_in_trace(file, error.diagnostics)) from None
        said += _in_trace(file, notices)
        notices.clear()
    return tuple(found), tuple(said)


def check(file: TraceFile) -> None:
    """Read a trace for what :func:`tltlc.monitor.traces.read_trace` raises alone."""
    for _ in _rows(file, ()):
        pass


def _rows(file: TraceFile, signals: Sequence[Signal]) -> Iterator[Sample]:
    return read_trace(io.BytesIO(file.data), file.name, signals)


def _letters(
    file: TraceFile, samples: Samples, words: Words, known: dict[tuple[float, ...], Letter]
) -> Iterator[Letter]:
    """The letters of a trace; ``known`` are those of samples that were seen before, of which there are many."""
    reader = words.reader
    names = [signal.name for signal in reader.signals]
    for number, row in enumerate(_rows(file, reader.signals), start=1):
        sample = tuple([row.get(name, nan) for name in names])
        letter = known.get(sample)
        if letter is None:
            values = samples.atom_values(row, number)
            check_exclusive(reader, values, number)
            letter = frozenset(atom.name for atom, value in zip(reader.atoms, values, strict=True) if value > 0.0)
            known[sample] = letter
        yield letter


def _in_trace(file: TraceFile, said: Iterable[Diagnostic]) -> list[Diagnostic]:
    """What a monitor said of a step, with the trace that it is a step of."""
    return [replace(each, title=f"`{file.name}`, {each.title}") for each in said]
