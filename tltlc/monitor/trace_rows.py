"""Read the rows of a trace in the format of ``docs/traces.md``, with all their columns."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping, Sequence
from itertools import chain
from typing import Any, Final, Protocol

from tltlc.core.record import record
from tltlc.core.source import SourceFile, SourceKind, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Label, TltlError
from tltlc.io.limits import TRACE_LINE
from tltlc.monitor.tapes import TapeHeader, TapeStep, header_from, is_header, samples_from, steps_from

JSON_LINES_HELP: Final = 'write one object a line, e.g. `{"health": 1.0, "seen": false}`'
_TAPE_HELP: Final = "give the name of a tape; `tltlc monitor` judges traces, too"
_INT_DIGITS: Final = 18
_BLANKS: Final = " \t"
_BYTE_ORDER_MARK: Final = b"\xef\xbb\xbf"
_UTF_16: Final = (b"\xff\xfe", b"\xfe\xff")
"""The bytes that a file in UTF-16 begins with."""
_NUMBER: Final = re.compile(
    r"[+-]?(?:(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:e[+-]?[0-9]+)?|inf|infinity|nan)", re.ASCII | re.IGNORECASE
)


class Stream(Protocol):
    """A binary file open for reading."""

    def readline(self, size: int = -1, /) -> bytes:
        """Return the next line, or its first ``size`` bytes; empty at the end."""


@record
class TraceTable:
    """A trace in CSV: the names of its columns, and an iterator over its rows, each with a cell for each column."""

    header: tuple[str, ...]
    rows: Iterator[list[str]]


@record
class TraceObjects:
    """A trace in JSON lines or a tape, as an iterator over its objects."""

    rows: Iterator[dict[str, Any]]


def read_rows(lines: TraceLines) -> TraceTable | TraceObjects | None:
    """Return a trace, in CSV, in JSON lines or as a tape; None if the stream has only blank lines.

    Raises:
        TltlError: TLT0622 the first row cannot be read. Iteration over ``rows`` of the result
            raises the same error for later rows.
    """
    first = lines.first_of_row()
    if first is None:
        return None
    if first.lstrip(_BLANKS).startswith("{"):
        objects = _objects(first, lines)
        start = next(objects)
        if is_header(start):
            return TraceObjects(samples_from(*_tape(start, objects, lines)))
        return TraceObjects(chain([start], objects))
    if first.lstrip(_BLANKS).startswith("[") and '"' in first:
        raise lines.error("this is a JSON list, not CSV", help=JSON_LINES_HELP)
    header = _cells(first, lines)
    return TraceTable(tuple(header), _rows(lines, len(header)))


def read_tape(lines: TraceLines) -> tuple[TapeHeader, Iterator[TapeStep]]:
    """Return the header of a tape, and an iterator over its steps.

    Raises:
        TltlError: TLT0620 there is no line, TLT0622 the first line is not the header of a tape.
            Iteration over the steps raises TLT0622 for later lines.
    """
    first = lines.first_of_row()
    if first is None:
        title = f"the tape `{lines.name}` is empty"
        raise TltlError([Diagnostic("TLT0620", title, help="record at least one step with its action")])
    objects = _objects(first, lines)
    start = next(objects)
    if not is_header(start):
        raise lines.error("this is not the header of a tape", help=_TAPE_HELP)
    return _tape(start, objects, lines)


def _tape(
    start: Mapping[str, Any], objects: Iterator[dict[str, Any]], lines: TraceLines
) -> tuple[TapeHeader, Iterator[TapeStep]]:
    def wrong(message: str, help_: str) -> TltlError:
        return lines.error(message, help=help_)

    header = header_from(start, wrong)
    return header, steps_from(header, objects, wrong)


def cell_number(cell: str) -> float | None:
    """Return the number in a cell; 1 for ``true``, 0 for ``false``, and None for any other text."""
    text = cell.strip(_BLANKS)
    if _NUMBER.fullmatch(text):
        return float(text)
    word = text.lower() if text.isascii() else ""
    return 1.0 if word == "true" else 0.0 if word == "false" else None


class TraceLines:
    """Reads the lines of a stream, and remembers for messages where the current row begins.

    ``name`` is the trace's name in messages. A row is one line, or several lines if a quoted cell
    contains line breaks. It has at most ``TRACE_LINE.size`` bytes. At most one row is kept in
    memory.
    """

    def __init__(self, stream: Stream, name: str, kind: SourceKind = "file") -> None:
        self.name = name
        self._kind: SourceKind = kind
        self.text = ""
        """The first line of the current row."""
        self._stream = stream
        self._read = 0
        self._first = 0
        self._used = 0

    @property
    def number(self) -> int:
        """The number of the first line of the current row, from 1."""
        return self._first

    def first_of_row(self) -> str | None:
        """Start a new row with the next line that is not blank, and return the line without its line feed.

        Returns None at the end of the stream.

        Raises:
            TltlError: TLT0622 the line is too long, is not UTF-8, or contains a NUL.
        """
        line: str | None = ""
        while line is not None and not line.removesuffix("\r").strip(_BLANKS):
            self._first, self._used, self.text = self._read + 1, 0, ""
            line = self.next_of_row()
        self.text = "" if line is None else line.removesuffix("\r")
        return line

    def next_of_row(self) -> str | None:
        """Return the next line, which continues the current row, without its line feed.

        Returns None at the end of the stream.

        Raises:
            TltlError: TLT0622 the line makes the row too long, is not UTF-8, or contains a NUL.
        """
        room = TRACE_LINE.size - self._used
        line = self._stream.readline(room + 1) if room >= 0 else b"-"
        if not line:
            return None
        self._read += 1
        line = line.removesuffix(b"\n")
        if len(line) > room:
            self.text = self.text or line[:80].decode(errors="replace")
            raise self.error(f"more than {TRACE_LINE.size:,} bytes", (0, 80), "close each quote, and end each row")
        self._used += len(line) + 1
        if self._read == 1:
            line = line.removeprefix(_BYTE_ORDER_MARK)
        return self._decode(line)

    def _decode(self, line: bytes) -> str:
        try:
            text = line.decode()
        except UnicodeDecodeError as error:
            if self._read == 1 and line.startswith(_UTF_16):
                help_ = "save it as UTF-8; in Excel, as `CSV UTF-8`"
                raise self._bad_line(b"", "it is UTF-16, not UTF-8", 0, help_) from None
            before = len(line[: error.start].decode())
            raise self._bad_line(line, "it is not UTF-8", before, "save it as UTF-8") from None
        if "\0" in text:
            raise self._bad_line(line, "it contains a NUL", text.index("\0"), "save it as text, in UTF-8")
        return text

    def _bad_line(self, line: bytes, message: str, column: int, help: str) -> TltlError:  # noqa: A002
        """Return the error TLT0622 about ``line``, the line that was read last.

        Makes this line the first line of the current row, even if the row began earlier.
        """
        self._first, self.text = self._read, line.decode(errors="replace")
        return self.error(message, (column, column + 1), help)

    def error(self, message: str, columns: tuple[int, int] | None = None, help: str | None = None) -> TltlError:  # noqa: A002
        """Return the error TLT0622 about the current row, with a label on the first line of the row.

        ``message`` is the message of the label. ``columns`` are the start and the end of the part of
        the line to mark, in characters from 0; by default the whole line.
        """
        title = f"line {self._first} of the trace cannot be read"
        return TltlError([Diagnostic("TLT0622", title, (self.label(message, columns),), help)])

    def label(self, message: str, columns: tuple[int, int] | None = None) -> Label:
        """Return a label on the first line of the current row.

        ``columns`` are the start and the end of the part of the line to mark, in characters from 0;
        by default the whole line.
        """
        start, end = columns or (0, len(self.text))
        offset = self._first - 1
        # Earlier lines are no longer in memory. Empty lines in their place make the number of this line right. A CR
        # inside the line would count as a line end.
        source = SourceFile(self.name, "\n" * offset + self.text.replace("\r", " "), self._kind)
        return Label(source, Span(offset + start, offset + max(start, end)), message)


def _lines(lines: TraceLines) -> Iterator[str]:
    while (line := lines.first_of_row()) is not None:
        yield line


# --- CSV ------------------------------------------------------------------------------------------


def _rows(lines: TraceLines, count: int) -> Iterator[list[str]]:
    for line in _lines(lines):
        cells = _cells(line, lines)
        if len(cells) != count:
            message = f"{_count_text(len(cells), 'value')} for {_count_text(count, 'column')}"
            raise lines.error(message, help="give each column one value; put a value that contains a comma in quotes")
        yield cells


def _cells(line: str, lines: TraceLines) -> list[str]:
    """Return the cells of a CSV row that begins with ``line``.

    A quoted cell may continue on further lines, which are read from ``lines``.
    """
    if '"' not in line:
        line = line.removesuffix("\r")
        _check_returns(line, lines)
        return [cell.strip(_BLANKS) for cell in line.split(",")]
    cells, position = [], -1
    while position < len(line):
        start = _after_blanks(line, position + 1)
        if line.startswith('"', start):
            cell, line, position = _quoted_cell(line, start + 1, lines)
        else:
            comma = line.find(",", start)
            position = len(line) if comma < 0 else comma
            cell = line[start:].removesuffix("\r") if comma < 0 else line[start:position]
            _check_returns(cell, lines)
            cell = cell.strip(_BLANKS)
        cells.append(cell)
    return cells


def _check_returns(text: str, lines: TraceLines) -> None:
    if "\r" in text:
        raise lines.error("a carriage return without a line feed", help="end lines with LF or CR LF")


def _quoted_cell(line: str, start: int, lines: TraceLines) -> tuple[str, str, int]:
    """Return the text of a quoted cell, and where the cell ends.

    ``start`` is the position after the opening quote. The second result is the line in which the
    cell ends. The third is the position in this line of the comma after the cell, or of the end of
    the line.
    """
    pieces = []
    while (end := _closing_quote(line, start)) < 0:
        pieces.append(line[start:])
        following = lines.next_of_row()
        if following is None:
            raise lines.error(
                "a quote is not closed", help="close each quote; write a quote inside a cell as two quotes"
            )
        line, start = following, 0
    pieces.append(line[start:end])
    position = _after_blanks(line, end + 1)
    position = len(line) if line.endswith("\r") and position == len(line) - 1 else position
    if position < len(line) and line[position] != ",":
        raise lines.error("a cell continues after its closing quote", help="write a quote inside a cell as two quotes")
    return "\n".join(pieces).replace('""', '"'), line, position


def _closing_quote(line: str, start: int) -> int:
    """Return the position of the closing quote of a cell, or -1 if it is not in this line.

    ``start`` is the position where the text of the cell begins or continues.
    """
    end = line.find('"', start)
    while end >= 0 and line.startswith('""', end):
        end = line.find('"', end + 2)
    return end


def _after_blanks(line: str, start: int) -> int:
    while line.startswith((" ", "\t"), start):
        start += 1
    return start


# --- JSON lines -----------------------------------------------------------------------------------


def _objects(first: str, lines: TraceLines) -> Iterator[dict[str, Any]]:
    """Yield the object of each line; ``first`` is the first line, which is read already."""
    return (_object(line, lines) for line in chain([first], _lines(lines)))


class _BadObjectError(ValueError):
    """Raised for a JSON object that is not allowed in a trace; the message says why."""


def _object(line: str, lines: TraceLines) -> dict[str, Any]:
    assert TRACE_LINE.values is not None
    assert TRACE_LINE.depth is not None
    try:
        if line.count(",") >= TRACE_LINE.values:
            raise _BadObjectError(f"this contains more than {TRACE_LINE.values:,} values")
        if "\r" in line.removesuffix("\r"):
            raise _BadObjectError("a carriage return without a line feed")
        value = json.loads(line, parse_int=_whole, object_pairs_hook=_with_unique_keys)
        if line.count("{") + line.count("[") > TRACE_LINE.depth and _depth(value) > TRACE_LINE.depth:
            raise RecursionError
    except json.JSONDecodeError as error:
        raise lines.error("this is not JSON", (error.pos, error.pos + 1), JSON_LINES_HELP) from None
    except RecursionError:
        raise lines.error(f"this nests deeper than {TRACE_LINE.depth} levels", help=JSON_LINES_HELP) from None
    except _BadObjectError as error:
        raise lines.error(str(error), help=JSON_LINES_HELP) from None
    if not isinstance(value, dict):
        raise lines.error("this is not an object", help=JSON_LINES_HELP)
    return value


def _whole(text: str) -> float:
    """Return a whole number of JSON. Longer ones become floats: they may have more digits than int() accepts."""
    return int(text) if len(text) <= _INT_DIGITS and text != "-0" else float(text)


def _with_unique_keys(pairs: Sequence[tuple[str, Any]]) -> dict[str, Any]:
    object_ = dict(pairs)
    if len(object_) < len(pairs):
        raise _BadObjectError("a key occurs twice")
    if any("\ud800" <= character <= "\udfff" for key in object_ if not key.isascii() for character in key):
        raise _BadObjectError("a key contains half a character")
    return object_


def _depth(value: Any) -> int:
    """Return the nesting depth of a JSON value; 0 for a scalar."""
    if not isinstance(value, (dict, list)):
        return 0
    return 1 + max(map(_depth, value.values() if isinstance(value, dict) else value), default=0)


def _count_text(number: int, thing: str) -> str:
    return f"{number} {thing}{'' if number == 1 else 's'}"
