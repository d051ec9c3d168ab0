"""Traces in unusual notation, and how they must be read according to ``docs/traces.md``."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from math import inf, nan
from typing import Final

from tltlc.core.record import record
from tltlc.expression.tree import Const, Expression, Op, SignalValue
from tltlc.logic import formula as f
from tltlc.resolve import spec
from tltlc.tools.conformance.case import CaseBuilders, ConformanceCase, automaton

SIGNALS: Final = (spec.Signal("x", "number", None, 1.0), spec.Signal("seen", "bool", 0.0, 1.0))


@record
class OddTrace:
    """A trace, and how a monitor must read it.

    ``trace`` is the content of a CSV file. ``samples`` has the values of the signals ``x`` and
    ``seen`` in each sample before an error. ``line`` is the number, from 1, of the line that must be
    rejected. It is None if no line must be rejected, and 0 if the error is that the trace has no
    sample.
    """

    trace: bytes
    samples: Sequence[tuple[float, float]] = ()
    line: int | None = None


_HEAD: Final = b"x,seen\n"
_ONE: Final = ((0.5, 1.0),)
_TWO: Final = ((0.5, 1.0), (-0.25, 0.0))


def _bad_row(row: bytes) -> OddTrace:
    """Return a trace whose second row is ``row`` and must be rejected."""
    return OddTrace(_HEAD + b"0.5,1\n" + row + b"\n0.5,1\n", _ONE, 3)


def _x_cell(cell: bytes, value: float | None) -> OddTrace:
    """Return a trace whose second row has ``cell`` in the column ``x``.

    ``value`` is how the cell must be read; None if it must be rejected.
    """
    if value is None:
        return _bad_row(cell + b",1")
    return OddTrace(_HEAD + b"0.5,1\n" + cell + b",1\n", (*_ONE, (value, 1.0)))


def _seen_cell(cell: bytes, value: float | None) -> OddTrace:
    """Return a trace whose second row has ``cell`` in the column ``seen``.

    ``value`` is how the cell must be read; None if it must be rejected.
    """
    if value is None:
        return _bad_row(b"0.5," + cell)
    return OddTrace(_HEAD + b"0.5,1\n0.5," + cell + b"\n", (*_ONE, (0.5, value)))


def _note(cell: bytes) -> OddTrace:
    """Return a trace with ``cell`` in a column that is not a signal. Monitors must ignore this cell."""
    return OddTrace(b"note,x,seen\n" + cell + b",0.5,1\n-,-0.25,0\n", _TWO)


def _bad_note(cell: bytes, line: int = 3) -> OddTrace:
    """Return a trace that must be rejected at ``line`` because of ``cell``, though its column is not a signal."""
    return OddTrace(b"note,x,seen\n-,0.5,1\n" + cell + b",0.5,1\n-,0.5,1\n", _ONE, line)


LINES: Final[Mapping[str, OddTrace]] = {
    "empty file": OddTrace(b"", line=0),
    "line ends alone": OddTrace(b"\n\r\n\n", line=0),
    "blanks alone": OddTrace(b" \t\n\t", line=0),
    "byte order mark alone": OddTrace(b"\xef\xbb\xbf", line=0),
    "header alone": OddTrace(_HEAD, line=0),
    "header without a line end": OddTrace(b"x,seen", line=0),
    "header and blank lines": OddTrace(_HEAD + b"\n \r\n", line=0),
    "LF": OddTrace(b"x,seen\n0.5,1\n-0.25,0\n", _TWO),
    "CR LF": OddTrace(b"x,seen\r\n0.5,1\r\n-0.25,0\r\n", _TWO),
    "LF and CR LF": OddTrace(b"x,seen\r\n0.5,1\n-0.25,0\r\n", _TWO),
    "no line end at the end": OddTrace(b"x,seen\n0.5,1\n-0.25,0", _TWO),
    "CR at the end": OddTrace(b"x,seen\r\n0.5,1\r\n-0.25,0\r", _TWO),
    "blank lines": OddTrace(b"\n\r\n \nx,seen\n\n0.5,1\n\t \n\r\n-0.25,0\n\n", _TWO),
    "the line number counts blank lines": OddTrace(b"\nx,seen\n\n0.5,1\r\n \n0.5,?\n", _ONE, 6),
    "CR as line end": OddTrace(b"x,seen\r0.5,1\r", line=1),
    "CR within a line": _bad_row(b"0.5\r,1"),
    "CR CR LF": _bad_row(b"0.5,1\r\r"),
    "CR on a line of its own": OddTrace(_HEAD + b"0.5,1\n\r\r\n0.5,1\n", _ONE, 3),
    "form feed as line end": OddTrace(b"x,seen\x0c0.5,1\n", line=1),
    "vertical tab as a blank line": _bad_row(b"\x0b"),
    "next line (U+0085) as line end": OddTrace("x,seen\x850.5,1\n".encode(), line=1),
    "line separator (U+2028) in a note": _note("a\u2028b".encode()),
    "no-break space on a line of its own": _bad_row("\u00a0".encode()),
    "control Z at the end": OddTrace(_HEAD + b"0.5,1\n\x1a", _ONE, 3),
    "byte order mark": OddTrace(b"\xef\xbb\xbfx,seen\n0.5,1\n-0.25,0\n", _TWO),
    "byte order mark and quotes": OddTrace(b'\xef\xbb\xbf"x",seen\n0.5,1\n', _ONE),
    "byte order mark and a blank line": OddTrace(b"\xef\xbb\xbf\nx,seen\n0.5,1\n", _ONE),
    "byte order mark twice": OddTrace(b"\xef\xbb\xbf\xef\xbb\xbfx,seen\n0.5,1\n", line=1),
    "byte order mark after a blank line": OddTrace(b"\n\xef\xbb\xbfx,seen\n0.5,1\n", line=2),
    "byte order mark before a value": _bad_row(b"\xef\xbb\xbf0.5,1"),
    "byte order mark in a note": _note(b"\xef\xbb\xbf"),
    "half a byte order mark": OddTrace(b"\xef\xbbx,seen\n0.5,1\n", line=1),
    "UTF-16, little end first": OddTrace("\ufeffx,seen\n0.5,1\n".encode("utf-16-le"), line=1),
    "UTF-16, big end first": OddTrace("\ufeffx,seen\n0.5,1\n".encode("utf-16-be"), line=1),
    "UTF-16 without a mark": OddTrace("x,seen\n0.5,1\n".encode("utf-16-le"), line=1),
    "UTF-32": OddTrace("\ufeffx,seen\n0.5,1\n".encode("utf-32-le"), line=1),
    "UTF-8": _note("é µ 漢 \U0001f600".encode()),
    "Latin-1": _bad_note("caf\xe9".encode("latin-1")),
    "Latin-1 in the header": OddTrace("x,seen,caf\xe9\n0.5,1,-\n".encode("latin-1"), line=1),
    "Latin-1 in quotes, on a later line": _bad_note(b'"a\nb\n\xe9"', 5),
    "UTF-8 that is cut off": OddTrace(_HEAD + b"0.5,1\n0.5,1,\xe2\x82", _ONE, 3),
    "UTF-8 that goes on in the next line": _bad_note(b"\xe2\n\x82\xac"),
    "UTF-8 that is too long": _bad_note(b"\xc0\xaf"),
    "UTF-8 that is too long, of three bytes": _bad_note(b"\xe0\x9f\xbf"),
    "UTF-8 that is too long, of four bytes": _bad_note(b"\xf0\x8f\xbf\xbf"),
    "half of a pair in UTF-8": _bad_note(b"\xed\xa0\x80"),
    "UTF-8 past the last character": _bad_note(b"\xf4\x90\x80\x80"),
    "first and last characters of UTF-8": _note(
        b"\xc2\x80\xdf\xbf\xe0\xa0\x80\xed\x9f\xbf\xee\x80\x80\xef\xbf\xbf\xf0\x90\x80\x80\xf4\x8f\xbf\xbf"
    ),
    "NUL in a note": _bad_note(b"a\0b"),
    "NUL in quotes": _bad_note(b'"a\0b"'),
    "NUL behind a value": _bad_row(b"0.5\0,1"),
    "NUL in the header": OddTrace(b"x\0,seen\n0.5,1\n", line=1),
    "NUL on a blank line": OddTrace(_HEAD + b"0.5,1\n\n\0\n0.5,1\n", _ONE, 4),
    "NUL at the end": OddTrace(_HEAD + b"0.5,1\n\0", _ONE, 3),
    "control characters in a note": _note(b"\x01\x1b[31m\x7f\x0b\x0c"),
}

CELLS: Final[Mapping[str, OddTrace]] = {
    "blanks around cells": OddTrace(b" x\t, seen \n\t0.5 , true\t\n -0.25\t,\t0 \n", _TWO),
    "quotes": OddTrace(b'"x","seen"\n"0.5","true"\n"-0.25","0"\n', _TWO),
    "blanks around quotes": OddTrace(b' "x"\t, "seen" \n\t"0.5" , "true"\t\n "-0.25"\t,"0" \r\n', _TWO),
    "blanks within the quotes of a value": _x_cell(b'" \t-0.25 "', -0.25),
    "blanks within the quotes of a name": OddTrace(b'" x",seen\n0.5,1\n', line=1),
    "a line end within the quotes of a value": _x_cell(b'"0.5\n"', None),
    "no-break space before a value": _x_cell("\u00a00.5".encode(), None),
    "no-break space behind a value": _x_cell("0.5\u00a0".encode(), None),
    "no-break space behind quotes": _x_cell('"0.5"\u00a0'.encode(), None),
    "no-break space around a name": OddTrace("x\u00a0,seen\n0.5,1\n".encode(), line=1),
    "thin space between digits": _x_cell("0.\u20095".encode(), None),
    "no width before a value": _x_cell("\u200b0.5".encode(), None),
    "vertical tab behind a value": _x_cell(b"0.5\x0b", None),
    "form feed before a value": _x_cell(b"\x0c0.5", None),
    "text behind quotes": _bad_row(b'"0.5"0,1'),
    "text behind quotes and a blank": _bad_row(b'"0.5" 0,1'),
    "text behind quotes in a note": _bad_note(b'"a"b'),
    "quotes behind quotes": _bad_row(b'"0.5" "0",1'),
    "quotes within a note": _note(b'say "hi"'),
    "quotes that are not closed": OddTrace(_HEAD + b'0.5,1\n"0.5,1\n0.5,1\n', _ONE, 3),
    "quotes that are not closed, alone": OddTrace(_HEAD + b'0.5,1\n"', _ONE, 3),
    "quotes that are not closed in the header": OddTrace(b'x,"seen\n0.5,1\n', line=1),
    "doubled quotes at the end": OddTrace(_HEAD + b'0.5,1\n0.5,"1""\n', _ONE, 3),
    "a comma in quotes": _note(b'"a, b,"'),
    "quotes in quotes": _note(b'"a ""b"" """'),
    "quotes alone in quotes": _note(b'""""'),
    "a line end in quotes": _note(b'"a\nb"'),
    "CR LF in quotes": _note(b'"a\r\nb\r\n"'),
    "CR in quotes": _note(b'"a\rb"'),
    "a blank line in quotes": _note(b'"a\n\n \nb"'),
    "a line end in quotes, and the number of a later line": OddTrace(b'note,x,seen\n"a\nb\n",0.5,1\n-,?,1\n', _ONE, 5),
    "a row is where it begins": OddTrace(b'note,x,seen\n-,0.5,1\n"a\nb",0.5,1,1\n', _ONE, 3),
    "a CR behind several lines in quotes": OddTrace(b'note,x,seen\n"a\nb",0.5,1\r\n"c\nd", -0.25 ,0\r\n', _TWO),
    "a quoted cell at the end, with CR LF": OddTrace(b'x,seen,"note"\r\n0.5,1,"a"\r\n-0.25,0,"" \r\n', _TWO),
    "a CR behind quotes": _bad_note(b'"a"\r'),
    "single quotes": _x_cell(b"'0.5'", None),
    "curly quotes": _x_cell("“0.5”".encode(), None),
    "backslash before quotes": _bad_note(b'"a\\"b"'),
    "a long cell": _note(b"a" * 140_000),
    "a long cell in quotes": _note(b'"' + b"a " * 70_000 + b'"'),
    "many columns": OddTrace(
        b"x,seen" + b",n" * 3000 + b"\n0.5,1" + b",-" * 3000 + b"\n-0.25,0" + b",-" * 3000 + b"\n", _TWO
    ),
    "empty cell": _bad_row(b",1"),
    "blank cell": _bad_row(b" \t,1"),
    "empty quotes": _bad_row(b'"",1'),
    "empty cell at the end": _bad_row(b"0.5,"),
    "a row of commas": _bad_row(b","),
    "a cell too few": _bad_row(b"0.5"),
    "a cell too many": _bad_row(b"0.5,1,1"),
    "a comma too many": _bad_row(b"0.5,1,"),
    "commas behind all rows": OddTrace(b"x,seen,\n0.5,1,\n-0.25,0,\n", _TWO),
    "empty quotes on a line of their own": _bad_row(b'""'),
    "columns that nothing reads": OddTrace(b"a,seen,b,x,c\n?,1,,0.5,nan\n,0,-,-0.25,1_0\n", _TWO),
    "two columns of one name that nothing reads": OddTrace(b"a,a,,,x,seen\n1,2,,,0.5,1\n", _ONE),
    "two columns of one name": OddTrace(b"x,seen,x\n0.5,1,0.5\n", line=1),
    "two columns of one name, one in quotes": OddTrace(b'\nx,"seen", seen\n0.5,1,1\n', line=2),
    "a column that is missing": OddTrace(b"\nx\n0.5\n", line=2),
    "a name in capitals": OddTrace(b"X,seen\n0.5,1\n", line=1),
    "semicolons": OddTrace(b"x;seen\n0.5;1\n", line=1),
    "tabs between columns": OddTrace(b"x\tseen\n0.5\t1\n", line=1),
    "a line that tells the separator": OddTrace(b"sep=,\nx,seen\n0.5,1\n", line=1),
    "a comment": OddTrace(b"# x and seen\nx,seen\n0.5,1\n", line=1),
    "the header again": OddTrace(_HEAD + b"0.5,1\nx,seen\n", _ONE, 3),
}

_NUMBERS: Final = (
    *((".5", 0.5), ("+.5", 0.5), ("-.5", -0.5), ("1.", 1.0), ("-0", -0.0), ("+0.0", 0.0), ("007e-1", 0.7)),
    *(("5e-1", 0.5), ("5E-1", 0.5), (".5e+0", 0.5), ("5.e-01", 0.5), ("0.025e0000000000000000000001", 0.25)),
    *(("1e-400", 0.0), ("-1e-400", -0.0), ("0e99999999999", 0.0), ("1e-99999999999", 0.0), ("5e-324", 5e-324)),
    *(("2.4703282292062328e-324", 5e-324), ("2.4703282292062327e-324", 0.0)),
    ("9007199254740993e-16", 0.9007199254740993),
    ("0.1000000000000000055511151231257827", 0.1),
    # Halfway between two doubles, the even one is read; slightly above, the upper one.
    ("0.500000000000000055511151231257827021181583404541015625", 0.5),
    ("0.500000000000000055511151231257827021181583404541015625" + "0" * 900 + "1", 0.5000000000000001),
    ("-0." + "0" * 400 + "1e400", -0.1),
    ("1" + "0" * 400 + "e-400", 1.0),
    ("0.5" + "0" * 2000 + "1", 0.5),
    # Some readers truncate exponents or digits, e.g. after 5,200. These values must still be read correctly.
    ("-0." + "0" * 20_000 + "25e20000", -0.25),
    ("0025" + "0" * 20_000 + ".0E-20002", 0.25),
    ("25" * 10_000 + "e-20000", 0.25252525252525254),
    *(("true", 1.0), ("FALSE", 0.0), ("tRuE", 1.0), ('" \t-0.25 "', -0.25)),
)
_TRUTHS: Final = (
    *(("true", 1.0), ("True", 1.0), ("FALSE", 0.0), ("1", 1.0), ("0", 0.0), ("1.0", 1.0), ("0e5", 0.0), ("-0", -0.0)),
    *(("+1.", 1.0), ("10e-1", 1.0), ('" true "', 1.0)),
)

VALUES: Final[Mapping[str, OddTrace]] = {
    "numbers": OddTrace(
        _HEAD + b"".join(f"{cell},1\n".encode() for cell, _ in _NUMBERS), tuple((value, 1.0) for _, value in _NUMBERS)
    ),
    "truths": OddTrace(
        _HEAD + b"".join(f"0.5,{cell}\n".encode() for cell, _ in _TRUTHS), tuple((0.5, value) for _, value in _TRUTHS)
    ),
    **{
        f"no number: {cell}": _x_cell(cell.encode(), None)
        for cell in (
            *(
                "x",
                "0x10",
                "0X1p-1",
                "1_000",
                "1 000",
                "1'000",
                "+-1",
                "--1",
                "+",
                ".",
                "e5",
                "1e",
                "1e+",
                "1.2.3",
                "1 2",
            ),
            *(
                "- 1",
                "1.5f",
                "1L",
                "5%",
                "½",
                "٣",
                "０.５",
                "−1",
                "∞",
                "tru",
                "truee",
                "yes",
                "+true",
                "nan(1)",
                "1.#INF",
            ),
            *("infinite", "İnf", "ınf", "falſe"),
        )
    },
    **{
        f"not finite: {cell}": OddTrace(_HEAD + b"0.5,1\n" + cell.encode() + b",1\n", (*_ONE, (value, 1.0)))
        for cell, value in (("nan", nan), ("-NaN", nan), ("-Inf", -inf), ("+INFINITY", inf), ("1e400", inf))
    },
    **{f"no truth: {cell}": _seen_cell(cell.encode(), None) for cell in ("2", "-1", "0.5", "yes", "nan", "inf")},
}

MORE_VALUES: Final[Mapping[str, OddTrace]] = {
    **{
        f"no number: {cell}": _x_cell(cell.encode(), None)
        for cell in (
            *(
                "0b1",
                "0o7",
                "++1",
                "-",
                ".e1",
                "1e1.5",
                "1e 5",
                "1d",
                "1m",
                "1j",
                "1/2",
                "(1)",
                "=1",
                "$1",
                "1．5",
                "no",
                "on",
            ),
            *(
                "t",
                "null",
                "None",
                "NA",
                "N/A",
                "#N/A",
                "in",
                "infinity1",
                "nan(ind)",
                "-1.#IND",
                "naN1",
                "ＴＲＵＥ",
                "1LL",
                "1i",
            ),
            *("0x", "1e+-1", "+", "..5", "5..", "1-", "1+1", "1e5e5", "e", "E1", "_1", "1_", "0x1", "Ÿ", "\u212a"),
        )
    },
    **{
        f"not finite: {cell[:30]}": OddTrace(_HEAD + b"0.5,1\n" + cell.encode() + b",1\n", (*_ONE, (value, 1.0)))
        for cell, value in (
            *(("NAN", nan), ("inf", inf), ("-1e999", -inf), ("1e99999999999999999999", inf), ("1" + "0" * 310, inf)),
            ("1.7976931348623159e308", inf),
        )
    },
    **{
        f"no truth: {cell}": _seen_cell(cell.encode(), None)
        for cell in ("T", "not", "1.0000000000000002", "true1", "5e-324")
    },
    "a very long number": _x_cell(b"0." + b"0123456789" * 10_000, 0.012345678901234568),
    "a very long whole number": OddTrace(_HEAD + b"0.5,1\n" + b"9" * 100_000 + b",1\n", (*_ONE, (inf, 1.0))),
    "a very long exponent": _x_cell(b"5e-" + b"0" * 100_000 + b"1", 0.5),
    "a million zeros and an exponent that takes them back": _x_cell(b"-0." + b"0" * 1_040_000 + b"25e1040000", -0.25),
    "a million digits and an exponent that takes them back": _x_cell(b"25" + b"0" * 1_040_000 + b"e-1040002", 0.25),
    "a million zeros and a larger exponent": OddTrace(
        _HEAD + b"0.5,1\n0." + b"0" * 1_040_000 + b"25e99999999999999999999,1\n", (*_ONE, (inf, 1.0))
    ),
    "a million digits and a smaller exponent": _x_cell(b"-" + b"9" * 1_040_000 + b"e-99999999999999999999", -0.0),
}
"""Traces that only tests read.

They are not in the corpus, because checking it starts a program for each trace.
"""


def _case(name: str, about: str, odd: Mapping[str, OddTrace]) -> ConformanceCase:
    seen = Op("-", (Op("*", (Const(2.0), SignalValue("seen"))), Const(1.0)))
    expressions: dict[str, Expression] = {"a": SignalValue("x"), "b": seen}
    formula = f.always(f.eventually(f.and_(f.atom("a"), f.atom("b"))))
    fspa = automaton(name, formula, expressions, SIGNALS, limit=50)
    return ConformanceCase(fspa, about, tuple(case.trace for case in odd.values()))


CASES: Final[CaseBuilders] = {
    name: partial(_case, name, about, odd)
    for name, about, odd in (
        ("trace_lines", "Encodings, line ends and blank lines, good ones and those that must be refused.", LINES),
        ("trace_cells", "Quotes, blanks and columns, good ones and those that must be refused.", CELLS),
        ("trace_values", "Ways to write a value, good ones and those that must be refused.", VALUES),
    )
}
