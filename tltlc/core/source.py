"""Source texts, and spans of source texts that diagnostics point at."""

from __future__ import annotations

from bisect import bisect_right
from typing import Literal

from tltlc.core.record import record

SourceKind = Literal["file", "standard library", "text"]


@record
class Span:
    """A half-open range of character offsets, ``start <= end``, into one source text."""

    start: int
    end: int

    def to(self, other: Span) -> Span:
        """Return the smallest span that covers this span and ``other``."""
        return Span(min(self.start, other.start), max(self.end, other.end))

    def covers(self, other: Span) -> bool:
        """Whether this span contains ``other`` or equals it."""
        return self.start <= other.start and other.end <= self.end


class SourceFile:
    """A text and its name in messages: a path, or ``<stdin>``.

    ``kind`` says where the text comes from: a file, a file of the standard library, or elsewhere
    (``"text"``). ``location`` is the path of the file, or the URI of a text that is open in an editor.
    Without a ``location``, the name is used.

    A lone carriage return is replaced by a newline, so that the lines are those that an editor shows.
    Offsets do not change.
    """

    __slots__ = ("_line_starts", "kind", "location", "name", "text")

    def __init__(self, name: str, text: str, kind: SourceKind = "file", location: str | None = None) -> None:
        self.name = name
        self.kind: SourceKind = kind
        self.location = name if location is None else location
        if "\r" in text:
            import re

            text = re.sub("\r(?!\n)", "\n", text)
        self.text = text
        starts = [0]
        position = text.find("\n")
        while position >= 0:
            starts.append(position + 1)
            position = text.find("\n", position + 1)
        self._line_starts = starts

    def __eq__(self, other: object) -> bool:
        return isinstance(other, SourceFile) and (self.name, self.text, self.kind, self.location) == (
            other.name,
            other.text,
            other.kind,
            other.location,
        )

    def __hash__(self) -> int:
        return hash((self.name, self.text))

    def __repr__(self) -> str:
        return f"SourceFile(name={self.name!r})"

    def with_text(self, text: str) -> SourceFile:
        """Return a source with another text, but the same name, kind and location."""
        return SourceFile(self.name, text, self.kind, self.location)

    def position(self, offset: int) -> tuple[int, int]:
        """Return the line and the column of a character offset, which counts from 0.

        Lines and columns count from 1. Columns count characters.
        """
        line = bisect_right(self._line_starts, offset)
        return line, offset - self._line_starts[line - 1] + 1

    def line(self, number: int) -> str:
        """Return the text of a line, without its line end; line numbers start at 1."""
        start = self._line_starts[number - 1]
        end = self._line_starts[number] if number < len(self._line_starts) else len(self.text)
        return self.text[start:end].rstrip("\r\n")

    def slice(self, span: Span) -> str:
        """Return the text that a span covers."""
        return self.text[span.start : span.end]
