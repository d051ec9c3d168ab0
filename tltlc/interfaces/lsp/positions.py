"""Offsets of characters as the positions of the protocol: lines from 0, columns in units of the agreed encoding.

A position takes logarithmic time: which signs of a text count more than one unit is found out once.
"""

from __future__ import annotations

import re
from bisect import bisect_left
from functools import lru_cache
from itertools import accumulate
from typing import Final

from lsprotocol import types

from tltlc.core.record import record
from tltlc.core.source import SourceFile, Span

UTF_16: Final = "utf-16"
"""The encoding where nothing is agreed upon: signs beyond the BMP (𝒰) count two."""

_WIDE: Final = {"utf-8": re.compile("[^\x00-\x7f]"), UTF_16: re.compile("[^\x00-\uffff]")}
"""The signs that count more than one unit; in UTF-32 there are none."""
_TEXTS: Final = 16
"""How many texts are kept with their wide signs: a request looks at few of them in turn."""


@record
class _Wide:
    """The offsets of the signs of a text that count more than one unit, in order, and how many units more.

    ``extra[i]`` is the sum for the first ``i`` of them.
    """

    offsets: tuple[int, ...]
    extra: tuple[int, ...]

    def units(self, start: int, end: int) -> int:
        """How many units the characters from ``start`` to ``end`` count."""
        first, last = bisect_left(self.offsets, start), bisect_left(self.offsets, end)
        return end - start + self.extra[last] - self.extra[first]


@lru_cache(maxsize=_TEXTS)
def _wide(text: str, encoding: str) -> _Wide:
    # A text that is asked about again is the same object: then neither its hash nor its comparison takes long.
    if encoding not in _WIDE or text.isascii():
        return _Wide((), (0,))
    found = [(each.start(), _units(each[0], encoding) - 1) for each in _WIDE[encoding].finditer(text)]
    return _Wide(tuple(at for at, _ in found), tuple(accumulate((more for _, more in found), initial=0)))


def position(source: SourceFile, offset: int, encoding: str = UTF_16) -> types.Position:
    """The position of a character; within a line end, that of its beginning."""
    at = min(max(0, offset), len(source.text))
    if at and source.text[at - 1 : at + 1] == "\r\n":
        at -= 1
    line, column = source.position(at)
    return types.Position(line - 1, _wide(source.text, encoding).units(at - column + 1, at))


def range_of(source: SourceFile, span: Span, encoding: str = UTF_16) -> types.Range:
    """The range that a span covers."""
    return types.Range(position(source, span.start, encoding), position(source, span.end, encoding))


def whole(source: SourceFile, encoding: str = UTF_16) -> types.Range:
    """The range of the whole text."""
    return range_of(source, Span(0, len(source.text)), encoding)


def offset(source: SourceFile, at: types.Position, encoding: str = UTF_16) -> int:
    """The character at a position; the nearest one where the text has no such place."""
    last, _ = source.position(len(source.text))
    if at.line >= last:
        return len(source.text)
    start, wide = _start(source, at.line), _wide(source.text, encoding)
    places = range(start, start + len(source.line(at.line + 1)))
    return start + bisect_left(places, at.character, key=lambda place: wide.units(start, place))


def _start(source: SourceFile, line: int) -> int:
    """The offset of the first character of a line that is there, from 0."""
    low, high = 0, len(source.text)
    while low < high:
        middle = (low + high) // 2
        if source.position(middle)[0] <= line:
            low = middle + 1
        else:
            high = middle
    return low


def _units(sign: str, encoding: str) -> int:
    """How many units a wide sign counts."""
    return len(sign.encode(errors="surrogatepass")) if encoding == "utf-8" else 2
