"""Read traces sample by sample, from CSV files with a header of signal names or from files with JSON lines."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, Final, NamedTuple

from tltlc.core.record import replace
from tltlc.core.source import SourceKind
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.grammar.typos import likely_name
from tltlc.monitor.sample_times import SampleTimes, lengths_name, times_name
from tltlc.monitor.samples import STEP_LENGTH, name_list, values_advice
from tltlc.monitor.trace_rows import (
    JSON_LINES_HELP,
    Stream,
    TraceLines,
    TraceObjects,
    TraceTable,
    cell_number,
    read_rows,
)
from tltlc.resolve.spec import Signal

TraceSample = dict[str, float]

_NUMBER_HELP: Final = "write a number, `true` or `false`"
_BOOL_HELP: Final = "write `true`, `false`, 1 or 0"
_SPARSE: Final = "`tltlc monitor --sparse` if a missing bool counts as false"


def read_trace(
    stream: Stream,
    name: str,
    signals: Sequence[Signal],
    clock_s: float | None = None,
    kind: SourceKind = "file",
    *,
    clock_varies: bool = False,
    sparse: bool = False,
) -> Iterator[TraceSample]:
    """Read a trace line by line, and yield for each sample the values of the given signals.

    ``docs/traces.md`` describes the format. ``stream`` is binary; ``name`` is the trace's name in
    messages, and ``kind`` its kind of source. The times in a column ``time`` are checked against
    the clock of the spec; ``clock_s`` is the period of the clock in seconds, None without a clock.
    If ``clock_varies``, each sample has its time since the sample before under
    :data:`~tltlc.monitor.samples.STEP_LENGTH`, from the column ``dt``, or else from ``time``.
    Other columns are ignored. In JSON lines, values may be missing; in all traces, numbers may be
    infinite or NaN. The monitor reports both. If the trace is ``sparse``, it has only the events that
    happened: a bool whose key, cell or column is missing is false.

    Raises:
        TltlError: TLT0620 the trace has no sample, TLT0621 it has no column for a signal, or for the
            time although the clock varies, TLT0622 a line cannot be read, TLT0623 the time of a sample
            is wrong. The iteration yields the samples before the error first.
    """
    lines = TraceLines(stream, name, kind)
    trace = read_rows(lines)
    samples: Iterator[TraceSample] = iter(())
    times = SampleTimes(clock_s, clock_varies)
    if isinstance(trace, TraceTable):
        samples = _table_samples(trace, lines, signals, times, sparse)
    elif trace is not None:
        samples = _object_samples(trace, lines, signals, times, sparse)
    count = 0
    for count, sample in enumerate(samples, start=1):  # noqa: B007 (counts)
        yield sample
    if not count:
        raise TltlError(
            [Diagnostic("TLT0620", f"the trace `{name}` contains no sample", help="record at least one step")]
        )


def in_trace(name: str, diagnostics: Iterable[Diagnostic]) -> tuple[Diagnostic, ...]:
    """Return the diagnostics of a monitor, with the name of the trace added to their titles."""
    return tuple(replace(diagnostic, title=f"`{name}`, {diagnostic.title}") for diagnostic in diagnostics)


class _TimeColumn(NamedTuple):
    """The column, or the key, with the times of the samples; or if ``is_length``, with the lengths of the steps."""

    name: str
    is_length: bool


def _time_column(names: Iterable[str], signals: Sequence[Signal], varies: bool) -> _TimeColumn | None:
    """Return the column that says when the samples are; None if there is none."""
    names = list(names)
    length = lengths_name(names, signals) if varies else None
    if length is not None:
        return _TimeColumn(length, True)
    time = times_name(names, signals)
    return None if time is None else _TimeColumn(time, False)


def _no_time_error(lines: TraceLines) -> TltlError:
    title = "the trace has no column `time` or `dt`, and the clock of the spec varies"
    advice = "record the time of each sample in seconds as `time`, or its time since the sample before as `dt`"
    return TltlError([Diagnostic("TLT0621", title, (lines.label(""),), advice)])


def _take_time(
    sample: TraceSample,
    time: float | None,
    column: _TimeColumn,
    times: SampleTimes,
    lines: TraceLines,
    columns: tuple[int, int] | None,
) -> None:
    """Check the time of the next sample, and if the clock varies, store its length in the sample.

    ``time`` is None if its cell does not contain a number. ``columns`` is the part of the line to
    mark, as in :meth:`TraceLines.error`. Raises TltlError (TLT0623) if the time is wrong.
    """
    if time is None:
        problem: str | None = "this is not a number"
    else:
        problem = times.length_problem(time) if column.is_length else times.problem(time)
    if times.varies:
        sample[STEP_LENGTH] = times.length_s
    if problem is not None:
        title = f"the time in line {lines.number} of the trace is wrong"
        advice = "write seconds with a decimal point, such as `12.5`" if time is None else times.advice
        raise TltlError([Diagnostic("TLT0623", title, (lines.label(problem, columns),), advice)])


# --- CSV ------------------------------------------------------------------------------------------


def _table_samples(
    trace: TraceTable, lines: TraceLines, signals: Sequence[Signal], times: SampleTimes, sparse: bool
) -> Iterator[TraceSample]:
    columns = _columns(trace.header, lines, signals, sparse)
    time = _time_column(trace.header, signals, times.varies)
    if time is None and times.varies:
        raise _no_time_error(lines)
    position = None if time is None else trace.header.index(time.name)
    if time is not None and trace.header.count(time.name) > 1:
        raise lines.error(f"two columns are called `{time.name}`", help="keep one of them")
    for row in trace.rows:
        sample = _row_sample(row, columns, lines, sparse)
        if time is not None and position is not None:
            _take_time(sample, cell_number(row[position]), time, times, lines, _cell_span(lines.text, position))
        yield sample


def _columns(
    header: Sequence[str], lines: TraceLines, signals: Sequence[Signal], sparse: bool
) -> list[tuple[Signal, int | None]]:
    """Return each signal with the position of its column in the trace, from 0; None for bools that are all false.

    Raises:
        TltlError: TLT0621 a signal has no column, TLT0622 a signal has two columns.
    """
    positions: dict[str, int] = {}
    twice = {name for position, name in enumerate(header) if positions.setdefault(name, position) != position}
    missing = [signal for signal in signals if signal.name not in positions]
    if sparse:
        # A column with a similar name is a typing error, and not an event that never happened.
        missing = [
            signal for signal in missing if not _is_bool(signal) or _advice_on_column(signal, header, lines, signals)
        ]
    if missing:
        raise _missing_columns_error(missing, header, lines, signals)
    for signal in signals:
        if signal.name in twice:
            raise lines.error(f"two columns are called `{signal.name}`", help="keep one of them")
    return [(signal, positions.get(signal.name)) for signal in signals]


def _missing_columns_error(
    missing: Sequence[Signal], header: Sequence[str], lines: TraceLines, signals: Sequence[Signal]
) -> TltlError:
    title = f"the trace has no column for {name_list([signal.name for signal in missing])}"
    advice = _advice_on_column(missing[0], header, lines, signals)
    if advice is None:
        advice = f"its columns are {name_list(header[:10])}" + (", …" if len(header) > 10 else "")
        advice += f"; use {_SPARSE}" if all(map(_is_bool, missing)) else ""
    return TltlError([Diagnostic("TLT0621", title, (lines.label(""),), advice)])


def _advice_on_column(
    signal: Signal, header: Sequence[str], lines: TraceLines, signals: Sequence[Signal]
) -> str | None:
    """Return advice if the header is wrong, or has a column that is meant for a signal without one; else None."""
    return _format_advice(lines.text, header) or _suggestion(signal.name, header, signals)


def _is_bool(signal: Signal) -> bool:
    return signal.type == "bool"


def _format_advice(line: str, header: Sequence[str]) -> str | None:
    """Return advice if the first line of a trace is no CSV header; None if nothing is wrong with the format.

    The line may begin a JSON list, separate its columns by semicolons or tabs, or name no columns.
    """
    if line.lstrip().startswith("["):
        return JSON_LINES_HELP
    if line.startswith(("#", "sep=")) or all(cell_number(cell) is not None for cell in header):
        return "the first line has to name the columns"
    return "separate the columns by commas" if ";" in line or "\t" in line else None


def _suggestion(name: str, columns: Sequence[str], signals: Sequence[Signal]) -> str | None:
    """Return advice about the column that is meant for a signal, or None if there is none.

    A column that has the name of another signal, even with other brackets and underscores, is meant for that one.
    """
    others = {_letters(signal.name) for signal in signals if signal.name != name}
    free = [column for column in columns if _letters(column) not in others]
    same = next((column for column in free if _letters(column) == _letters(name)), None)
    if same is not None:
        return f"rename the column `{same}` to `{name}`"
    close = likely_name(name, free)
    return f"did you mean the column `{close}`?" if close else None


def _letters(name: str) -> str:
    """Return the letters and digits of a name alone, without the capitals."""
    return "".join(character for character in name.lower() if character.isalnum())


def _row_sample(
    row: Sequence[str], columns: Sequence[tuple[Signal, int | None]], lines: TraceLines, sparse: bool
) -> TraceSample:
    sample = {}
    for signal, column in columns:
        if column is None or (sparse and not row[column] and _is_bool(signal)):
            sample[signal.name] = 0.0
            continue
        value = _named_value(signal, row[column].strip(" \t"))
        value = cell_number(row[column]) if value is None else value
        if value is None or not _is_allowed(signal, value):
            message = _problem(signal, value, row[column]) if row[column] else f"`{signal.name}` has no value"
            advice = f"{_BOOL_HELP}, or use {_SPARSE}" if _is_bool(signal) and not row[column] else _advice(signal)
            raise lines.error(message, _cell_span(lines.text, column), advice)
        sample[signal.name] = value
    return sample


def _named_value(signal: Signal, name: str) -> float | None:
    """Return the number of the value of an enum with this name; None if there is no such value."""
    return float(signal.values.index(name)) if name in signal.values else None


def _is_allowed(signal: Signal, value: float) -> bool:
    return not _is_bool(signal) or value in (0.0, 1.0)


def _problem(signal: Signal, value: float | None, given: object) -> str:
    """Return in words what is wrong with the value of a signal, which the trace has as ``given``."""
    if signal.values and value is None:
        return f"`{signal.name}` has no value `{given!s:.40}`"
    return f"this value of `{signal.name}` is {'not a number' if value is None else 'not true or false'}"


def _advice(signal: Signal) -> str:
    if signal.values:
        return values_advice(signal)
    return _BOOL_HELP if _is_bool(signal) else _NUMBER_HELP


def _cell_span(line: str, column: int) -> tuple[int, int] | None:
    """Return where a cell begins and ends in its line.

    Returns None if the line has quotes, which may contain commas, or has no such column.
    """
    cells = line.split(",")
    if '"' in line or column >= len(cells):
        return None
    start = sum(len(cell) + 1 for cell in cells[:column])
    return start, start + max(1, len(cells[column]))


# --- JSON lines -----------------------------------------------------------------------------------


def _object_samples(
    trace: TraceObjects, lines: TraceLines, signals: Sequence[Signal], times: SampleTimes, sparse: bool
) -> Iterator[TraceSample]:
    first: _TimeColumn | None = None
    for number, object_ in enumerate(trace.rows):
        sample = _object_sample(object_, signals, lines, sparse)
        column = _time_column(object_, signals, times.varies)
        if number == 0:
            first = column
            if column is None and times.varies:
                raise _no_time_error(lines)
        if column != first:
            has = "has no time" if column is None else f"has `{column.name}`"
            help_ = "give every row its time, or none"
            if times.varies and first is not None:
                help_ = f"give every row its `{first.name}`: the clock of the spec varies"
            raise lines.error(f"this row {has}, unlike the first row", help=help_)
        if column is not None:
            time = object_[column.name]
            number_given = float(time) if isinstance(time, (int, float)) else None
            _take_time(sample, number_given, column, times, lines, None)
        yield sample


def _object_sample(
    object_: Mapping[str, Any], signals: Sequence[Signal], lines: TraceLines, sparse: bool
) -> TraceSample:
    sample = {}
    for signal in signals:
        given = object_.get(signal.name)
        if given is None:
            if sparse and _is_bool(signal):
                sample[signal.name] = 0.0
            continue  # the monitor reports missing values

        number = _named_value(signal, given) if isinstance(given, str) else None
        value = float(given) if isinstance(given, (int, float)) else number
        if value is None or not _is_allowed(signal, value):
            raise lines.error(_problem(signal, value, given), help=_advice(signal))
        sample[signal.name] = value
    return sample
