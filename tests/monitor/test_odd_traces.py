"""`tltlc monitor`, and the program of the target ``python``, read odd traces as ``docs/traces.md`` specifies.

``tests/tools/conformance`` tests the programs in other languages, which read only CSV.
"""

from __future__ import annotations

import io
import json
from collections.abc import Iterator, Mapping
from functools import cache
from math import inf, nan
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.monitor.odd_bytes import csv_traces, json_traces
from tltlc.backends import emit
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.io.limits import TRACE_LINE
from tltlc.monitor.traces import read_trace
from tltlc.tools.conformance.corpus import CASES
from tltlc.tools.conformance.odd_traces import CELLS, LINES, MORE_VALUES, SIGNALS, VALUES, OddTrace
from tltlc.tools.mine.columns import ColumnKind, columns

ONE = ((0.5, 1.0),)


def _object(line: bytes, x: float = 0.5) -> OddTrace:
    """Return a trace whose second object is ``line``, with ``x`` as the value of its signal ``x``."""
    return OddTrace(b'{"x": 0.5, "seen": 1}\n' + line + b"\n", (*ONE, (x, 1.0)))


def _bad(line: bytes) -> OddTrace:
    """Return a trace whose second object is ``line``, which is an error."""
    return OddTrace(b'{"x": 0.5, "seen": 1}\n' + line + b'\n{"x": 0.5, "seen": 1}\n', ONE, 2)


OBJECTS: Mapping[str, OddTrace] = {
    "objects": _object(b'{"seen": true, "x": -0.25}', -0.25),
    "blanks": OddTrace(b'\n \t{ "x" :\t0.5, "seen": true } \r\n\r\n \n{"x": 0.5, "seen": 1}', (*ONE, *ONE)),
    "a byte order mark": OddTrace(b'\xef\xbb\xbf{"x": 0.5, "seen": 1}\n', ONE),
    "a byte order mark later": _bad(b'\xef\xbb\xbf{"x": 0.5, "seen": 1}'),
    "no-break space": _bad('\u00a0{"x": 0.5, "seen": 1}'.encode()),
    "no-break space first": OddTrace('\u00a0{"x": 0.5, "seen": 1}'.encode(), line=1),
    "other keys": _object(b'{"x": 0.5, "seen": 1, "note": "\\u00e9\\n", "inner": {"x": [1, {"seen": null}]}, "": 1}'),
    "a carriage return alone": _bad(b'{"x": 0.5,\r "seen": 1}'),
    "two carriage returns": _bad(b'{"x": 0.5, "seen": 1}\r\r'),
    "a key twice": _bad(b'{"x": 0.5, "seen": 1, "x": 0.5}'),
    "another key twice": _bad(b'{"x": 0.5, "seen": 1, "a": 1, "a": 1}'),
    "an inner key twice": _bad(b'{"x": 0.5, "seen": 1, "a": {"b": 1, "b": 1}}'),
    "a key with escapes": _object(b'{"\\u0078": 0.5, "s\\u0065en": 1}'),
    "a key twice, once with escapes": _bad(b'{"\\u0078": 0.5, "x": 0.5, "seen": 1}'),
    "half of a pair in a key": _bad(b'{"x": 0.5, "seen": 1, "\\ud83d": 1}'),
    "a pair in a key": _object(b'{"x": 0.5, "seen": 1, "\\ud83d\\ude00": 1}'),
    "half of a pair in a value": _object(b'{"x": 0.5, "seen": 1, "a": "\\ud83d"}'),
    "UTF-8 that is cut off": _bad(b'{"x": 0.5, "seen": 1, "a": "\xc3"}'),
    "Latin-1": _bad(b'{"x": 0.5, "seen": 1, "a": "\xe9"}'),
    "NUL": _bad(b'{"x": 0.5, "seen": 1, "a": "\0"}'),
    "a tab in a text": _bad(b'{"x": 0.5, "seen": 1, "a": "\t"}'),
    "a large number": _object(b'{"x": 1' + b"0" * 5000 + b', "seen": 1}', inf),
    "a whole number of many digits": _object(b'{"x": 9007199254740993, "seen": 1}', 9007199254740992.0),
    "exponents": _object(b'{"x": 5e-1, "seen": 10E-1}'),
    "a small number": _object(b'{"x": 1e-999, "seen": 1}', 0.0),
    "NaN": _object(b'{"x": NaN, "seen": 1}', nan),
    "Infinity": _object(b'{"x": -Infinity, "seen": 1, "a": NaN}', -inf),
    "nan": _bad(b'{"x": nan, "seen": 1}'),
    "True": _bad(b'{"x": 0.5, "seen": True}'),
    "a plus": _bad(b'{"x": +0.5, "seen": 1}'),
    "a number that begins with a point": _bad(b'{"x": .5, "seen": 1}'),
    "a number that ends with a point": _bad(b'{"x": 5., "seen": 1}'),
    "a number with zeros before it": _bad(b'{"x": 00.5, "seen": 1}'),
    "a hexadecimal number": _bad(b'{"x": 0x1, "seen": 1}'),
    "a number as text": _bad(b'{"x": "0.5", "seen": 1}'),
    "a number in a list": _bad(b'{"x": [0.5], "seen": 1}'),
    "true for a number": _object(b'{"x": true, "seen": 1}', 1.0),
    "no truth": _bad(b'{"x": 0.5, "seen": 2}'),
    "NaN for a truth": _bad(b'{"x": 0.5, "seen": NaN}'),
    "a list": _bad(b"[1]"),
    "a number": _bad(b"1"),
    "null": _bad(b"null"),
    "two objects on a line": _bad(b'{"x": 0.5, "seen": 1} {"x": 0.5, "seen": 1}'),
    "a comma at the end": _bad(b'{"x": 0.5, "seen": 1},'),
    "a comma too many": _bad(b'{"x": 0.5, "seen": 1,}'),
    "single quotes": _bad(b"{'x': 0.5, 'seen': 1}"),
    "a comment": _bad(b'{"x": 0.5, "seen": 1} // once'),
    "an object that is cut off": _bad(b'{"x": 0.5, "se'),
    "an object on several lines": OddTrace(b'{"x": 0.5,\n"seen": 1}\n', line=1),
    "a carriage return between objects": OddTrace(b'{"x": 0.5, "seen": 1}\r{"x": 0.5, "seen": 1}\n', line=1),
    "32 levels": _object(b'{"x": 0.5, "seen": 1, "a": ' + b"[" * 31 + b"]" * 31 + b"}"),
    "33 levels": _bad(b'{"x": 0.5, "seen": 1, "a": ' + b"[" * 32 + b"]" * 32 + b"}"),
    "many lists that do not nest": _object(b'{"x": 0.5, "seen": 1, "a": [' + b"[], " * 99 + b"[]]}"),
    "many levels that do not end": _bad(b'{"a": ' + b"[" * 200_000),
    "many values": _bad(b'{"x": 0.5, "seen": 1, "a": [' + b"1," * TRACE_LINE.values + b"1]}"),  # type: ignore[operator]
    "a long line": _object(b'{"x": 0.5, "seen": 1}' + b" " * (TRACE_LINE.size - 21)),
    "a line that is too long": _bad(b'{"x": 0.5, "seen": 1}' + b" " * (TRACE_LINE.size - 20)),
    "CSV": _bad(b"0.5,1"),
}

_FOLDED = (b"-" * 63 + b"\n") * (TRACE_LINE.size // 64)

LARGE: Mapping[str, OddTrace] = {
    "a row of the greatest length": OddTrace(
        b"x,seen\n0.5" + b" " * (TRACE_LINE.size - 6) + b",1\r\n0.5,1\n", (*ONE, *ONE)
    ),
    "a row that is a byte too long": OddTrace(b"x,seen\n0.5" + b" " * (TRACE_LINE.size - 5) + b",1\r\n", line=2),
    "a row of many lines": OddTrace(b'x,seen,\n0.5,1,"' + b"-" * 56 + _FOLDED[64:] + b'"\n', ONE),
    "a row of too many lines": OddTrace(b'x,seen,\n0.5,1,"' + b"-" * 57 + _FOLDED[64:] + b'"\n', line=2),
    "a quote that is not closed, and much after it": OddTrace(b'x,seen\n0.5,1\n"' + b"0.5,1\n" * 300_000, ONE, 3),
    "many digits and a letter": OddTrace(b"x,seen\n" + b"1" * 200_000 + b"x,1\n", line=2),
    "many cells in quotes": OddTrace(b"x,seen" + b',"a"' * 200_000 + b"\n0.5,1" + b',"a"' * 200_000 + b"\n", ONE),
}

ODD: Mapping[str, OddTrace] = {**LINES, **CELLS, **VALUES, **MORE_VALUES, **OBJECTS, **LARGE}


@cache
def program() -> dict[str, Any]:
    """Return the namespace of the module that the target ``python`` generates."""
    text = emit("python", CASES["trace_values"]().fspa)["trace_values_monitor.py"]
    namespace: dict[str, Any] = {"__name__": "monitor"}
    exec(text, namespace)
    return namespace


def _values(samples: Iterator[Mapping[str, float]], rows: list[tuple[float, ...]]) -> None:
    # The rows before an error are kept.
    rows.extend(tuple(sample[signal.name] for signal in SIGNALS) for sample in samples)


def outcome(trace: bytes) -> tuple[list[tuple[float, ...]], int | None]:
    """Return the samples, and the line of the error, which is 0 for a trace without samples."""
    samples: list[tuple[float, ...]] = []
    try:
        _values(read_trace(io.BytesIO(trace), "trace", SIGNALS), samples)
    except TltlError as error:
        (diagnostic,) = error.diagnostics
        if diagnostic.code == "TLT0620":
            return samples, 0
        return samples, diagnostic.labels[0].source.position(diagnostic.labels[0].span.start)[0]
    return samples, None


def outcome_of_program(trace: bytes) -> tuple[list[tuple[float, ...]], int | None]:
    """Return the samples and the line of the error from the generated program."""
    module = program()
    samples: list[tuple[float, ...]] = []
    try:
        _values(module["_samples"](module["_Lines"](io.BytesIO(trace))), samples)
    except module["MonitorError"] as error:
        return samples, int(str(error).removeprefix("line ").partition(":")[0])
    return samples, None if samples else 0


@pytest.mark.parametrize("name", ODD)
def test_odd_traces_are_read_as_documented(name: str) -> None:
    odd = ODD[name]
    for samples, line in (outcome(odd.trace), outcome_of_program(odd.trace)):
        # As texts, -0 differs from 0, and nan equals nan.
        assert (repr(samples), line) == (repr([*odd.samples]), odd.line)


@pytest.mark.parametrize("name", ODD)
def test_mine_reads_columns_by_the_same_rules(name: str) -> None:
    """It reports errors on the same lines, but does not compare columns and values with signals."""
    odd = ODD[name]
    samples, line = outcome(odd.trace)
    try:
        columns_read = columns(odd.trace, "trace")
    except TltlError as error:
        label = error.diagnostics[0].labels[0]
        assert label.source.position(label.span.start)[0] == line
    else:
        if line is None:
            assert {"x", "seen"} <= columns_read.keys()
            assert (columns_read["x"] is ColumnKind.TRUTHS) == all(x in (0.0, 1.0) for x, _ in samples)


@given(csv_traces())
def test_the_generated_program_reads_random_traces_like_the_monitor(trace: bytes) -> None:
    assert repr(outcome(trace)) == repr(outcome_of_program(trace))


@given(json_traces())
def test_the_generated_program_reads_random_objects_like_the_monitor(trace: bytes) -> None:
    assert repr(_or_none(outcome, trace)) == repr(_or_none(outcome_of_program, trace))


def _or_none(read: Any, trace: bytes) -> Any:
    try:
        return read(trace)
    except KeyError:
        # The monitor, not the reader, reports a missing value.
        return None


@given(st.binary(max_size=80) | csv_traces() | json_traces(), st.integers(0, 3))
def test_any_bytes_are_samples_or_an_error(data: bytes, head: int) -> None:
    trace = (b"", b"x,seen\n", b'{"x": 1, "seen": 1}\n', b'"')[head] + data
    for read in (outcome, outcome_of_program):
        _or_none(read, trace)
    try:
        columns(trace, "trace")
    except TltlError as error:
        assert error.diagnostics[0].code == "TLT0622"


class Endless:
    """A stream that repeats a byte or a line forever, and counts the bytes that are read."""

    def __init__(self, start: bytes, piece: bytes) -> None:
        self.start, self.piece, self.bytes_read = start, piece, 0

    def readline(self, size: int = -1, /) -> bytes:
        assert size >= 0, "a line is read without a limit"
        line = self.start[:size] or (self.piece[:size] if b"\n" in self.piece else self.piece * size)
        line = line[: line.index(b"\n") + 1] if b"\n" in line else line
        self.start = self.start[len(line) :]
        self.bytes_read += len(line)
        return line


@pytest.mark.parametrize(
    ("start", "piece"),
    [(b"", b"a"), (b"x,seen\n", b"1"), (b'x,seen\n"', b"-" * 63 + b"\n"), (b"{", b" "), (b"x,seen\n", b'"')],
    ids=range(5),
)
def test_at_most_one_row_is_read_into_memory(start: bytes, piece: bytes) -> None:
    """This holds for a line, or a quoted cell, that never ends."""
    for read in (
        lambda stream: [*read_trace(stream, "trace", SIGNALS)],
        lambda stream: [*program()["_samples"](program()["_Lines"](stream))],
    ):
        stream = Endless(start, piece)
        with pytest.raises((TltlError, program()["MonitorError"])):
            read(stream)
        assert stream.bytes_read <= TRACE_LINE.size + len(start) + 2


def test_both_readers_have_the_same_limits() -> None:
    module = program()
    limits = (module["_ROW_BYTES"], module["_JSON_DEPTH"], module["_JSON_VALUES"])
    assert limits == (TRACE_LINE.size, TRACE_LINE.depth, TRACE_LINE.values)


def test_objects_of_a_json_writer_are_read() -> None:
    rows = [{"x": 0.1, "seen": True, "höhe": None}, {"x": -1e-7, "seen": False, "höhe": [1]}]
    for ascii_ in (True, False):
        text = "".join(f"{json.dumps(row, ensure_ascii=ascii_)}\n" for row in rows)
        assert outcome(text.encode()) == ([(0.1, 1.0), (-1e-7, 0.0)], None)
