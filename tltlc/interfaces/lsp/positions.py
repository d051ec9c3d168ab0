"""Convert between character offsets in a text and positions of the Language Server Protocol.

A position has a line, counted from 0, and a column, counted in units of an encoding that the editor
chooses: bytes in UTF-8, 16-bit units in UTF-16, characters in UTF-32. A conversion takes
logarithmic time, because the characters that count more than one unit are located only once for
each text.
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
"""The default encoding; characters above U+FFFF, such as 𝒰, count two units."""

_WIDE: Final = {"utf-8": re.compile("[^\x00-\x7f]"), UTF_16: re.compile("[^\x00-\uffff]")}
"""The characters that count more than one unit; in UTF-32 there are none."""
_TEXTS: Final = 16
"""For how many texts the wide characters are cached; one request needs few texts."""


@record
class _Wide:
    """The offsets of wide characters in a text, in order, and their extra units.

    A wide character counts more than one unit. ``extra[i]`` is the sum of the extra units of the
    first ``i`` wide characters.
    """

    offsets: tuple[int, ...]
    extra: tuple[int, ...]

    def units(self, start: int, end: int) -> int:
        """Return how many units the characters from ``start`` to ``end`` count."""
        first, last = bisect_left(self.offsets, start), bisect_left(self.offsets, end)
        return end - start + self.extra[last] - self.extra[first]


@lru_cache(maxsize=_TEXTS)
def _wide(text: str, encoding: str) -> _Wide:
    # Repeated calls pass the same text object, so its hash is cached and comparing it is fast.
    if encoding not in _WIDE or text.isascii():
        return _Wide((), (0,))
    wide = [(match.start(), _units(match[0], encoding) - 1) for match in _WIDE[encoding].finditer(text)]
    return _Wide(tuple(at for at, _ in wide), tuple(accumulate((extra for _, extra in wide), initial=0)))


def position(source: SourceFile, offset: int, encoding: str = UTF_16) -> types.Position:
    """Return the position of the character at an offset.

    Between the two characters of a CRLF, return the end of the line; beyond the text, the nearest
    position in it.
    """
    at = min(max(0, offset), len(source.text))
    if at and source.text[at - 1 : at + 1] == "\r\n":
        at -= 1
    line, column = source.position(at)
    return types.Position(line - 1, _wide(source.text, encoding).units(at - column + 1, at))


def range_of(source: SourceFile, span: Span, encoding: str = UTF_16) -> types.Range:
    """Return a span of a source text as a range of positions."""
    return types.Range(position(source, span.start, encoding), position(source, span.end, encoding))


def whole(source: SourceFile, encoding: str = UTF_16) -> types.Range:
    """Return the whole source text as a range of positions."""
    return range_of(source, Span(0, len(source.text)), encoding)


def offset(source: SourceFile, at: types.Position, encoding: str = UTF_16) -> int:
    """Return the offset of the character at a position.

    Beyond the end of a line, return the end of the line; below the last line, the end of the text.
    """
    last, _ = source.position(len(source.text))
    if at.line >= last:
        return len(source.text)
    start, wide = _start(source, at.line), _wide(source.text, encoding)
    places = range(start, start + len(source.line(at.line + 1)))
    return start + bisect_left(places, at.character, key=lambda place: wide.units(start, place))


def _start(source: SourceFile, line: int) -> int:
    """Return the offset of the first character of an existing line; line 0 is the first line."""
    low, high = 0, len(source.text)
    while low < high:
        middle = (low + high) // 2
        if source.position(middle)[0] <= line:
            low = middle + 1
        else:
            high = middle
    return low


def _units(sign: str, encoding: str) -> int:
    """Return how many units a wide character counts."""
    return len(sign.encode(errors="surrogatepass")) if encoding == "utf-8" else 2
