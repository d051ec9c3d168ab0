"""Read traces, one sample at a time: CSV with a header of signal names, or JSON lines of objects."""

from __future__ import annotations

import csv
import json
from collections.abc import Iterable, Iterator, Sequence
from itertools import chain
from typing import Final

from tltlc.diagnostics.diagnostic import Diagnostic, Label, TltlError
from tltlc.json_text import loads
from tltlc.limits import TRACE_LINE
from tltlc.monitor.samples import listed
from tltlc.resolve.spec import Signal
from tltlc.source import SourceFile, Span

Sample = dict[str, float]

_BOOLS: Final = {"true": 1.0, "false": 0.0}
_OBJECTS: Final = 'write one object a line, e.g. `{"health": 1.0, "seen": false}`'
_VALUES: Final = "write a number, `true` or `false`"
_BYTE_ORDER_MARK: Final = "\ufeff"


def read_trace(lines: Iterable[bytes], name: str, signals: Sequence[Signal]) -> Iterator[Sample]:
    """The samples of a trace, as the lines come in: the values of the signals, others are ignored.

    ``lines`` is a binary stream, UTF-8; ``name`` is what messages call it.  Where the first line begins with
    ``{``, each line is a JSON object, else the trace is CSV.  Values are numbers, ``true`` or ``false``.  Blank lines
    do not count.  A value that is no finite number is left to the monitor.

    Raises:
        TltlError: TLT0620 no sample, TLT0621 no column for a signal, TLT0622 a line that cannot be
            read; while iterating, when the reader gets there.
    """
    texts = _Lines(lines, name)
    for first in texts:
        if first.strip():
            all_lines = chain([first], texts)
            read = _json_lines if first.lstrip().startswith("{") else _csv
            samples = read(all_lines, texts, signals)
            break
    else:
        raise _empty(name)
    count = 0
    for count, sample in enumerate(samples, start=1):  # noqa: B007 (counts)
        yield sample
    if not count:
        raise _empty(name)


class _Lines:
    """The decoded lines of a stream; remembers the present one for messages."""

    def __init__(self, lines: Iterable[bytes], name: str) -> None:
        self._lines = iter(lines)
        self.name = name
        self.number = 0
        self.text = ""

    def __iter__(self) -> Iterator[str]:
        return self

    def __next__(self) -> str:
        line = next(self._lines)
        self.number += 1
        try:
            self.text = line.decode()
        except UnicodeDecodeError as error:
            self.text = line.decode(errors="replace")
            before = len(line[: error.start].decode())
            raise self.error("it is not UTF-8", (before, before + 1), "save it as UTF-8") from None
        if self.number == 1:
            self.text = self.text.removeprefix(_BYTE_ORDER_MARK)
        return self.text

    def error(self, remark: str, columns: tuple[int, int] | None = None, help: str | None = None) -> TltlError:  # noqa: A002
        """TLT0622, pointing at the present line or at some of its columns (from 0)."""
        title = f"line {self.number} of the trace cannot be read"
        return TltlError([Diagnostic("TLT0622", title, (self.label(remark, columns),), help)])

    def label(self, remark: str, columns: tuple[int, int] | None = None) -> Label:
        """A place in the present line."""
        text = self.text.rstrip("\r\n")
        start, end = columns or (0, len(text))
        offset = self.number - 1
        # The lines before have gone by; empty ones keep the number right.
        source = SourceFile(self.name, "\n" * offset + text)
        return Label(source, Span(offset + start, offset + max(start, end)), remark)


# --- CSV ------------------------------------------------------------------------------------------


def _csv(lines: Iterator[str], at: _Lines, signals: Sequence[Signal]) -> Iterator[Sample]:
    rows = csv.reader(lines, skipinitialspace=True, strict=True)
    header = [cell.strip() for cell in _next_row(rows, at) or []]
    columns = _columns(header, at, signals)
    while (row := _next_row(rows, at)) is not None:
        if not row:
            continue
        if len(row) != len(header):
            remark = f"{_counted(len(row), 'value')}, under {_counted(len(header), 'column')}"
            raise at.error(remark, help="give each column one value, in quotes where it holds a comma")
        yield {name: _cell(row[column], name, column, at) for name, column in columns}


def _next_row(rows: Iterator[list[str]], at: _Lines) -> list[str] | None:
    try:
        return next(rows, None)
    except csv.Error as error:
        raise at.error(f"this is no CSV: {error}", help="close each quote; write those inside as two") from None


def _columns(header: Sequence[str], at: _Lines, signals: Sequence[Signal]) -> list[tuple[str, int]]:
    """The signals and the positions of their columns."""
    missing = [signal.name for signal in signals if signal.name not in header]
    if missing:
        title = f"the trace has no column for {listed(missing)}"
        found = f"its columns are {listed(header[:10])}" + (", …" if len(header) > 10 else "")
        way_out = _other_form(at.text) or _suggestion(missing[0], header) or found
        raise TltlError([Diagnostic("TLT0621", title, (at.label(""),), way_out)])
    for signal in signals:
        if header.count(signal.name) > 1:
            raise at.error(f"two columns are called `{signal.name}`", help="keep one of them")
    return [(signal.name, header.index(signal.name)) for signal in signals]


def _other_form(line: str) -> str | None:
    """What to do where the line looks like the start of something other than commas between names."""
    if line.lstrip().startswith("["):
        return _OBJECTS
    return "separate the columns by commas" if ";" in line or "\t" in line else None


def _suggestion(name: str, known: Sequence[str]) -> str | None:
    from difflib import get_close_matches

    squeezed = {"".join(other.split()): other for other in known}
    close = get_close_matches("".join(name.split()), list(squeezed), n=1)
    return f"is the column `{squeezed[close[0]]}` meant?" if close else None


def _cell(cell: str, name: str, column: int, at: _Lines) -> float:
    text = cell.strip()
    value = _BOOLS.get(text.lower())
    if value is not None:
        return value
    try:
        # Python's own reading of numbers takes more than a spreadsheet writes.
        if not text.isascii() or "_" in text:
            raise ValueError
        return float(text)
    except ValueError:
        remark = f"this value of `{name}` is no number" if text else f"`{name}` has no value"
        raise at.error(remark, _cell_span(at.text, column), help=_VALUES) from None


def _cell_span(line: str, column: int) -> tuple[int, int] | None:
    """Where a cell stands in its line; None where quotes make that hard to say."""
    cells = line.rstrip("\r\n").split(",")
    if '"' in line or column >= len(cells):
        return None
    start = sum(len(cell) + 1 for cell in cells[:column])
    return start, start + max(1, len(cells[column]))


# --- JSON lines -----------------------------------------------------------------------------------


def _json_lines(lines: Iterator[str], at: _Lines, signals: Sequence[Signal]) -> Iterator[Sample]:
    names = [signal.name for signal in signals]
    for line in lines:
        if not line.strip():
            continue
        try:
            found = loads(line, TRACE_LINE)
        except json.JSONDecodeError as error:
            raise at.error("this is not JSON", (error.pos, error.pos + 1), _OBJECTS) from None
        except (RecursionError, ValueError):
            raise at.error("this nests too deep, or holds a number that is too long", help=_OBJECTS) from None
        if not isinstance(found, dict):
            raise at.error("this is no object", help=_OBJECTS)
        for name in names:
            # A null is a missing value, and the monitor's business.
            if found.get(name) is not None and not isinstance(found[name], (int, float)):
                raise at.error(f"this value of `{name}` is no number", help=_VALUES)
        yield {name: _json_number(value) for name, value in found.items() if isinstance(value, (int, float))}


def _json_number(value: float) -> float:
    try:
        return float(value)
    except OverflowError:
        return float("inf")


# --- messages -------------------------------------------------------------------------------------


def _empty(name: str) -> TltlError:
    return TltlError([Diagnostic("TLT0620", f"the trace `{name}` holds no sample", help="record at least one step")])


def _counted(number: int, thing: str) -> str:
    return f"{number} {thing}{'' if number == 1 else 's'}"
