"""Read the rows of a trace by the rules of ``docs/traces.md``, before it is known which columns matter."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Sequence
from itertools import chain
from typing import Any, Final, Protocol

from tltlc.core.record import record
from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Label, TltlError
from tltlc.io.limits import TRACE_LINE

OBJECTS: Final = 'write one object a line, e.g. `{"health": 1.0, "seen": false}`'
_BLANKS: Final = " \t"
_BYTE_ORDER_MARK: Final = b"\xef\xbb\xbf"
_NUMBER: Final = re.compile(
    r"[+-]?(?:(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:e[+-]?[0-9]+)?|inf|infinity|nan)", re.ASCII | re.IGNORECASE
)


class Stream(Protocol):
    """A binary file that is open for reading."""

    def readline(self, size: int = -1, /) -> bytes:
        """The next line, or its first ``size`` bytes; nothing at the end."""


@record
class Table:
    """A trace in CSV: its columns, and its rows, each as long as ``header``, as they are read."""

    header: tuple[str, ...]
    rows: Iterator[list[str]]


@record
class Objects:
    """A trace in JSON lines, as they are read."""

    rows: Iterator[dict[str, Any]]


def read_rows(lines: Lines) -> Table | Objects | None:
    """The trace on these lines, as CSV or JSON lines; None where it is blank.

    Raises:
        TltlError: TLT0622 a line that cannot be read; the rows raise it when the reader gets there.
    """
    first = lines.first_of_row()
    if first is None:
        return None
    if first.lstrip(_BLANKS).startswith("{"):
        return Objects(_object(line, lines) for line in chain([first], _lines(lines)))
    header = _cells(first, lines)
    return Table(tuple(header), _rows(lines, len(header)))


def cell_number(cell: str) -> float | None:
    """The number in a cell, 1 or 0 for true or false; None where there is none."""
    text = cell.strip(_BLANKS)
    if _NUMBER.fullmatch(text):
        return float(text)
    word = text.lower() if text.isascii() else ""
    return 1.0 if word == "true" else 0.0 if word == "false" else None


class Lines:
    """The lines of a stream, decoded and checked; remembers where the present row begins, for messages.

    ``name`` is what messages call the trace.  No more of it is held than a row, which has at most
    ``TRACE_LINE.size`` bytes.
    """

    def __init__(self, stream: Stream, name: str) -> None:
        self.name = name
        self.text = ""
        """The first line of the present row."""
        self._stream = stream
        self._read = 0
        self._first = 0
        self._used = 0

    def first_of_row(self) -> str | None:
        """The next line that is not blank, with which a row begins, without its line feed; None at the end.

        Raises:
            TltlError: TLT0622, as :meth:`next_of_row`.
        """
        line: str | None = ""
        while line is not None and not line.removesuffix("\r").strip(_BLANKS):
            self._first, self._used, self.text = self._read + 1, 0, ""
            line = self.next_of_row()
        self.text = "" if line is None else line.removesuffix("\r")
        return line

    def next_of_row(self) -> str | None:
        """The next line, which belongs to the present row, without its line feed; None at the end.

        Raises:
            TltlError: TLT0622, it makes the row too long, is not UTF-8, or holds a NUL.
        """
        room = TRACE_LINE.size - self._used
        line = self._stream.readline(room + 1) if room >= 0 else b"-"
        if not line:
            return None
        self._read += 1
        line = line.removesuffix(b"\n")
        if len(line) > room:
            self.text = self.text or line[:80].decode(errors="replace")
            raise self.error(f"more than {TRACE_LINE.size:,} bytes", (0, 80), "close each quote, end each row")
        self._used += len(line) + 1
        if self._read == 1:
            line = line.removeprefix(_BYTE_ORDER_MARK)
        return self._decoded(line)

    def _decoded(self, line: bytes) -> str:
        try:
            text = line.decode()
        except UnicodeDecodeError as error:
            before = len(line[: error.start].decode())
            raise self._bad_line(line, "it is not UTF-8", before, "save it as UTF-8") from None
        if "\0" in text:
            raise self._bad_line(line, "it holds a NUL", text.index("\0"), "save it as text, in UTF-8")
        return text

    def _bad_line(self, line: bytes, remark: str, column: int, help: str) -> TltlError:  # noqa: A002
        """The error of the present line, whichever line the row began with."""
        self._first, self.text = self._read, line.decode(errors="replace")
        return self.error(remark, (column, column + 1), help)

    def error(self, remark: str, columns: tuple[int, int] | None = None, help: str | None = None) -> TltlError:  # noqa: A002
        """TLT0622, pointing at the line in which the present row begins, or at some of its columns (from 0)."""
        title = f"line {self._first} of the trace cannot be read"
        return TltlError([Diagnostic("TLT0622", title, (self.label(remark, columns),), help)])

    def label(self, remark: str, columns: tuple[int, int] | None = None) -> Label:
        """A place in the line in which the present row begins."""
        start, end = columns or (0, len(self.text))
        offset = self._first - 1
        # The lines before have gone by; empty ones keep the number right. A CR would count as a line end.
        source = SourceFile(self.name, "\n" * offset + self.text.replace("\r", " "))
        return Label(source, Span(offset + start, offset + max(start, end)), remark)


def _lines(lines: Lines) -> Iterator[str]:
    while (line := lines.first_of_row()) is not None:
        yield line


# --- CSV ------------------------------------------------------------------------------------------


def _rows(lines: Lines, count: int) -> Iterator[list[str]]:
    for line in _lines(lines):
        cells = _cells(line, lines)
        if len(cells) != count:
            remark = f"{_counted(len(cells), 'value')}, under {_counted(count, 'column')}"
            raise lines.error(remark, help="give each column one value, in quotes where it holds a comma")
        yield cells


def _cells(line: str, lines: Lines) -> list[str]:
    """The cells of a row that begins with this line; further lines are read where quotes go on there."""
    if '"' not in line:
        line = line.removesuffix("\r")
        _check_returns(line, lines)
        return [cell.strip(_BLANKS) for cell in line.split(",")]
    cells, place = [], -1
    while place < len(line):
        start = _after_blanks(line, place + 1)
        if line.startswith('"', start):
            cell, line, place = _quoted(line, start + 1, lines)
        else:
            found = line.find(",", start)
            place = len(line) if found < 0 else found
            cell = line[start:].removesuffix("\r") if found < 0 else line[start:place]
            _check_returns(cell, lines)
            cell = cell.strip(_BLANKS)
        cells.append(cell)
    return cells


def _check_returns(text: str, lines: Lines) -> None:
    if "\r" in text:
        raise lines.error("a carriage return stands alone", help="end lines with LF or CR LF")


def _quoted(line: str, start: int, lines: Lines) -> tuple[str, str, int]:
    """A cell whose text begins there in a line; the line in which it ends, and where the comma or the end is."""
    pieces = []
    while (end := _closing_quote(line, start)) < 0:
        pieces.append(line[start:])
        following = lines.next_of_row()
        if following is None:
            raise lines.error("a quote is not closed", help="close each quote; write those inside as two")
        line, start = following, 0
    pieces.append(line[start:end])
    place = _after_blanks(line, end + 1)
    place = len(line) if line.endswith("\r") and place == len(line) - 1 else place
    if place < len(line) and line[place] != ",":
        raise lines.error("a cell goes on after its quotes", help="write quotes inside a cell as two")
    return "\n".join(pieces).replace('""', '"'), line, place


def _closing_quote(line: str, start: int) -> int:
    """Where the quotes end that go on there in a line; -1 where they do not."""
    end = line.find('"', start)
    while end >= 0 and line.startswith('""', end):
        end = line.find('"', end + 2)
    return end


def _after_blanks(line: str, start: int) -> int:
    while line.startswith((" ", "\t"), start):
        start += 1
    return start


# --- JSON lines -----------------------------------------------------------------------------------


class _BadObjectError(ValueError):
    """JSON that a trace must not hold; the message says what."""


def _object(line: str, lines: Lines) -> dict[str, Any]:
    assert TRACE_LINE.values is not None
    assert TRACE_LINE.depth is not None
    try:
        if line.count(",") >= TRACE_LINE.values:
            raise _BadObjectError(f"this holds more than {TRACE_LINE.values:,} values")
        if "\r" in line.removesuffix("\r"):
            raise _BadObjectError("a carriage return stands alone")
        # Whole numbers may have more digits than Python's own reading takes.
        found = json.loads(line, parse_int=float, object_pairs_hook=_with_keys_once)
        if line.count("{") + line.count("[") > TRACE_LINE.depth and _depth(found) > TRACE_LINE.depth:
            raise RecursionError
    except json.JSONDecodeError as error:
        raise lines.error("this is not JSON", (error.pos, error.pos + 1), OBJECTS) from None
    except RecursionError:
        raise lines.error(f"this nests deeper than {TRACE_LINE.depth} levels", help=OBJECTS) from None
    except _BadObjectError as error:
        raise lines.error(str(error), help=OBJECTS) from None
    if not isinstance(found, dict):
        raise lines.error("this is no object", help=OBJECTS)
    return found


def _with_keys_once(pairs: Sequence[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) < len(pairs):
        raise _BadObjectError("a key stands twice")
    if any("\ud800" <= character <= "\udfff" for key in found if not key.isascii() for character in key):
        raise _BadObjectError("a key holds half a character")
    return found


def _depth(value: Any) -> int:
    """How deep a JSON value nests; 0 for one that holds no others."""
    if not isinstance(value, (dict, list)):
        return 0
    return 1 + max(map(_depth, value.values() if isinstance(value, dict) else value), default=0)


def _counted(number: int, thing: str) -> str:
    return f"{number} {thing}{'' if number == 1 else 's'}"
