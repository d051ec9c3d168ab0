"""Read traces, one sample at a time: CSV with a header of signal names, or JSON lines of objects."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Final

from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.monitor.samples import listed
from tltlc.monitor.trace_rows import OBJECTS, Lines, Stream, Table, cell_number, read_rows
from tltlc.resolve.spec import Signal

Sample = dict[str, float]

_VALUES: Final = "write a number, `true` or `false`"
_TRUTHS: Final = "write `true`, `false`, 1 or 0"


def read_trace(stream: Stream, name: str, signals: Sequence[Signal]) -> Iterator[Sample]:
    """The samples of a trace, as the lines come in: the values of the signals, others are ignored.

    ``stream`` is binary; ``name`` is what messages call it.  ``docs/traces.md`` has the rules.  A value that is
    missing from a JSON object, and one that is not finite, is left to the monitor.

    Raises:
        TltlError: TLT0620 no sample, TLT0621 no column for a signal, TLT0622 a line that cannot be
            read; while iterating, when the reader gets there.
    """
    lines = Lines(stream, name)
    trace = read_rows(lines)
    samples: Iterator[Sample] = iter(())
    if isinstance(trace, Table):
        columns = _columns(trace.header, lines, signals)
        samples = (_row_sample(row, columns, lines) for row in trace.rows)
    elif trace is not None:
        samples = (_object_sample(found, signals, lines) for found in trace.rows)
    count = 0
    for count, sample in enumerate(samples, start=1):  # noqa: B007 (counts)
        yield sample
    if not count:
        raise TltlError([Diagnostic("TLT0620", f"the trace `{name}` holds no sample", help="record at least one step")])


# --- CSV ------------------------------------------------------------------------------------------


def _columns(header: Sequence[str], at: Lines, signals: Sequence[Signal]) -> list[tuple[Signal, int]]:
    """The signals and the positions of their columns."""
    places: dict[str, int] = {}
    twice = {name for place, name in enumerate(header) if places.setdefault(name, place) != place}
    missing = [signal.name for signal in signals if signal.name not in places]
    if missing:
        title = f"the trace has no column for {listed(missing)}"
        found = f"its columns are {listed(header[:10])}" + (", …" if len(header) > 10 else "")
        way_out = _other_form(at.text) or _suggestion(missing[0], header) or found
        raise TltlError([Diagnostic("TLT0621", title, (at.label(""),), way_out)])
    for signal in signals:
        if signal.name in twice:
            raise at.error(f"two columns are called `{signal.name}`", help="keep one of them")
    return [(signal, places[signal.name]) for signal in signals]


def _other_form(line: str) -> str | None:
    """What to do where the line looks like the start of something other than commas between names."""
    if line.lstrip().startswith("["):
        return OBJECTS
    return "separate the columns by commas" if ";" in line or "\t" in line else None


def _suggestion(name: str, known: Sequence[str]) -> str | None:
    from difflib import get_close_matches

    squeezed = {"".join(other.split()): other for other in known}
    close = get_close_matches("".join(name.split()), list(squeezed), n=1)
    return f"is the column `{squeezed[close[0]]}` meant?" if close else None


def _row_sample(row: Sequence[str], columns: Sequence[tuple[Signal, int]], at: Lines) -> Sample:
    sample = {}
    for signal, column in columns:
        value = cell_number(row[column])
        if value is None or not _is_allowed(signal, value):
            remark = _problem(signal, value) if row[column] else f"`{signal.name}` has no value"
            raise at.error(remark, _cell_span(at.text, column), _way_out(signal))
        sample[signal.name] = value
    return sample


def _is_allowed(signal: Signal, value: float) -> bool:
    return signal.type != "bool" or value in (0.0, 1.0)


def _problem(signal: Signal, value: float | None) -> str:
    """What is wrong with the value of a signal."""
    return f"this value of `{signal.name}` is {'no number' if value is None else 'not true or false'}"


def _way_out(signal: Signal) -> str:
    return _TRUTHS if signal.type == "bool" else _VALUES


def _cell_span(line: str, column: int) -> tuple[int, int] | None:
    """Where a cell stands in its line; None where quotes make that hard to say."""
    cells = line.split(",")
    if '"' in line or column >= len(cells):
        return None
    start = sum(len(cell) + 1 for cell in cells[:column])
    return start, start + max(1, len(cells[column]))


# --- JSON lines -----------------------------------------------------------------------------------


def _object_sample(found: Mapping[str, Any], signals: Sequence[Signal], at: Lines) -> Sample:
    sample = {}
    for signal in signals:
        given = found.get(signal.name)
        if given is None:
            # A missing value is the monitor's business.
            continue
        value = float(given) if isinstance(given, (int, float)) else None
        if value is None or not _is_allowed(signal, value):
            raise at.error(_problem(signal, value), help=_way_out(signal))
        sample[signal.name] = value
    return sample
