"""Offsets of characters as the positions of the protocol: lines from 0, columns in units of the agreed encoding."""

from __future__ import annotations

from typing import Final

from lsprotocol import types

from tltlc.source import SourceFile, Span

UTF_16: Final = "utf-16"
"""The encoding where nothing is agreed upon: signs beyond the BMP (𝒰) count two."""


def position(source: SourceFile, offset: int, encoding: str = UTF_16) -> types.Position:
    """The position of a character."""
    line, column = source.position(min(max(0, offset), len(source.text)))
    return types.Position(line - 1, _units(source.line(line)[: column - 1], encoding))


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
    text = source.line(at.line + 1)
    start = _start(source, at.line)
    if text.isascii():
        return start + min(at.character, len(text))
    units = 0
    for column, sign in enumerate(text):
        if units >= at.character:
            return start + column
        units += _units(sign, encoding)
    return start + len(text)


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


def _units(text: str, encoding: str) -> int:
    if encoding == "utf-32" or text.isascii():
        return len(text)
    if encoding == "utf-8":
        return len(text.encode(errors="surrogatepass"))
    return len(text) + sum(sign > "\uffff" for sign in text)
