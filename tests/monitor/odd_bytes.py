"""Random traces made of pieces that are hard for readers of CSV and JSON."""

from __future__ import annotations

from hypothesis import strategies as st

_BLANKS = (b" ", b"\t", b"\r", b"\x0b", b"\x0c", "\u00a0".encode(), "\u2028".encode(), "\x85".encode(), b"\xef\xbb\xbf")
_BAD = (b"\0", b"\xff", b"\xc3", b"\xed\xa0\x80", b"\x80", b"\xf0\x9f\x98", b"\xc0\x80", b"\x1a", b"\x01")
_CELLS = (
    *(
        b"0.5",
        b"-0.25",
        b"1",
        b"0",
        b"true",
        b"False",
        b"1e-1",
        b".5",
        b"5.",
        b"",
        b"nan",
        b"-inf",
        b"1e999",
        b"0x1",
        b"1_0",
    ),
    *(
        b'"0.5"',
        b'"1"',
        b'""',
        b'"a\nb"',
        b'"a,b"',
        b'"a""b"',
        b' "0" ',
        b'"a\r\n"',
        b"x",
        b"seen",
        "é".encode(),
        b'a"b',
    ),
)
_ENDS = (b"\n", b"\n", b"\n", b"\r\n", b"\r\n", b"\n\n", b"\r\r\n", b"\r", b" \n", b"\n\r\n")
_ODD = (*_BLANKS, *_BAD, b'"', b'""', b",", b"+", b"-", b"e", b"1", b"\n")
_HEADS = (b"x,seen", b'"x" , seen', b"\xef\xbb\xbfx,seen", b"note,x,seen", b'x,"a\nb",seen', b"\n \r\nx,seen")


def csv_traces() -> st.SearchStrategy[bytes]:
    """CSV traces over ``x`` and ``seen`` with nearly valid rows and occasional odd bytes."""
    return st.builds(
        _trace, st.sampled_from(_HEADS), st.lists(_rows(), max_size=5), st.sampled_from((b"", b"\n", b"\r"))
    )


def _rows() -> st.SearchStrategy[tuple[bytes, bytes]]:
    valid = st.tuples(st.sampled_from((b"0.5", b"-0.25", b'"0.5"', b" 1 ")), st.sampled_from((b"1", b"true", b'"0"')))
    cells = valid | valid | st.lists(st.sampled_from(_CELLS), min_size=1, max_size=4)
    odd = st.just(b"") | st.lists(st.sampled_from(_ODD), max_size=3).map(b"".join)
    rows = st.builds(_with, cells.map(b",".join), odd, st.integers(0, 12))
    return st.tuples(rows, st.sampled_from(_ENDS))


def _with(row: bytes, odd: bytes, place: int) -> bytes:
    return row[:place] + odd + row[place:]


def _trace(head: bytes, rows: list[tuple[bytes, bytes]], end: bytes) -> bytes:
    count = 3 if head.count(b",") == 2 else 2
    lines = [b"-," * (count - 2) + row + between for row, between in rows]
    return head + b"\n" + b"".join(lines) + end


_KEYS = (b'"x"', b'"seen"', b'"\\u0078"', b'"\\ud800"', b'"a"', b'""', b'"\xc3"', b"x")
_VALUES = (
    *(
        b"0.5",
        b"1",
        b"true",
        b"false",
        b"null",
        b"NaN",
        b"-Infinity",
        b"1e999",
        b"00",
        b'"1"',
        b"[1]",
        b"{}",
        b'{"a": 1}',
    ),
    *(b"9" * 400, b"[" * 40 + b"]" * 40, b'{"a": 1, "a": 2}', b"", b"\0"),
)


def json_traces() -> st.SearchStrategy[bytes]:
    """JSON-lines traces over ``x`` and ``seen``; some lines are odd."""
    valid = st.sampled_from((b'{"x": 0.5, "seen": 1}', b' {"seen": true, "x": -0.25, "a": "b"} '))
    pairs = st.builds(lambda key, value: key + b":" + value, st.sampled_from(_KEYS), st.sampled_from(_VALUES))
    odd = st.lists(pairs, max_size=4).map(lambda members: b"{" + b", ".join(members) + b"}")
    lines = st.tuples(valid | valid | odd, st.sampled_from(_ENDS))
    return st.lists(lines, max_size=5).map(lambda members: b"".join(line + end for line, end in members))
