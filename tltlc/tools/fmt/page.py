"""The page that is written: its lines, with the comments of the source where they belong."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from tltlc.core.source import SourceFile, Span
from tltlc.grammar.tree import Comment

WIDTH: Final = 100
"""The most columns of a line, where its words and comments allow it."""

STEP: Final = 4
"""By how many columns what belongs to a line is indented."""

_DEEPEST: Final = 60
"""No line begins further to the right, however deep it is nested: there would be no room for it."""

_GAP: Final = 2
"""Blanks between a line and the comment behind it."""

_OPENERS: Final = ("{", "(", ":", "=")
"""Ends of lines whose comments speak of all that follows, and not of the next line."""


class Page:
    """Lines that grow from left to right; comments join them in the order of the source.

    A comment behind code stays behind it, one on a line of its own stays on one.
    """

    def __init__(self, source: SourceFile, comments: Sequence[Comment]) -> None:
        self._text = source.text
        self._comments = comments
        self._next = 0
        self._lines: list[str] = []
        self._remarks: dict[int, str] = {}
        self._is_comment = False
        self._fresh = True
        self._indent = 0
        self._opened = 0

    def put(self, text: str) -> None:
        """Write on, on a new line where the last one has ended."""
        if self._fresh:
            self._lines.append(" " * self._indent + text.lstrip(" "))
            self._fresh = self._is_comment = False
        else:
            self._lines[-1] += text

    def end_line(self, indent: int) -> None:
        """What is put next begins a line there."""
        self._fresh = True
        self._indent = min(indent, _DEEPEST)

    def begin(self, joined: bool, indent: int) -> None:
        """What is put next begins a line there, or stands behind this one where that does not end in a comment."""
        if joined and not self._fresh:
            self.put(" ")
        else:
            self.end_line(indent)

    def put_as_written(self, span: Span) -> None:
        """Write a part of the source, and the comments in it, as it stands there."""
        while self.has_comment(span.end):
            self._next += 1
        first, *others = (line.rstrip() for line in self._text[span.start : span.end].split("\n"))
        self.put(first)
        for place, line in enumerate(others):
            if line or others[place - 1]:
                self._lines.append(line)

    def open_block(self) -> None:
        """No empty line follows here."""
        self._opened = len(self._lines)

    @property
    def is_fresh(self) -> bool:
        """Whether what is put next begins a line."""
        return self._fresh

    @property
    def room(self) -> int:
        """How many columns are left."""
        return WIDTH - (self._indent if self._fresh else len(self._lines[-1]))

    @property
    def indent(self) -> int:
        """Where the line begins."""
        if self._fresh:
            return self._indent
        line = self._lines[-1]
        return len(line) - len(line.lstrip(" "))

    def has_comment(self, end: int, start: int = 0) -> bool:
        """Whether a comment that is still to be written stands before an offset (and not before ``start``)."""
        for place in range(self._next, len(self._comments)):
            at = self._comments[place].span.start
            if at >= start:
                return at < end
        return False

    def find(self, sign: str, start: int) -> int:
        """The first place of a sign behind an offset of the source, comments that are still to be written left out."""
        place = self._text.find(sign, start)
        for number in range(self._next, len(self._comments)):
            span = self._comments[number].span
            if span.start > place:
                break
            if place < span.end:
                place = self._text.find(sign, span.end)
        return place

    def comments(self, end: int, indent: int, *, gaps: bool = False) -> None:
        """Write the comments before an offset; what follows them begins a line at ``indent``, as they do.

        With ``gaps``, empty lines in front of them stay.
        """
        while self._next < len(self._comments) and self._comments[self._next].span.start < end:
            comment = self._comments[self._next]
            self._next += 1
            if self._lines and not self._is_comment and not self._stands_alone(comment):
                self._remarks[len(self._lines) - 1] = comment.text
            else:
                if gaps:
                    self.gap(comment.span.start)
                self._lines.append(" " * min(indent, _DEEPEST) + comment.text)
            self._is_comment = True
            self.end_line(indent)

    def gap(self, offset: int) -> None:
        """An empty line, where the source has any in front of this offset."""
        start = offset
        while start and self._text[start - 1].isspace():
            start -= 1
        if len(self._lines) > self._opened and self._text.count("\n", start, offset) > 1:
            self._lines.append("")

    def text(self) -> str:
        """All lines, each with a line feed; comments behind lines of one kind stand in one column."""
        lines = [line.rstrip() for line in self._lines]
        group: list[int] = []
        for place in sorted(self._remarks):
            if group and (place != group[-1] + 1 or lines[group[-1]].endswith(_OPENERS)):
                self._align(lines, group)
                group = []
            group.append(place)
        self._align(lines, group)
        return "".join(f"{line}\n" for line in lines)

    def _align(self, lines: list[str], group: list[int]) -> None:
        """Put comments behind their lines: in one column, unless one of them would then end beyond the width."""
        widest = max((len(lines[place]) for place in group), default=0)
        if any(widest + _GAP + len(self._remarks[place]) > WIDTH for place in group):
            widest = 0
        for place in group:
            lines[place] = lines[place].ljust(widest) + " " * _GAP + self._remarks[place]

    def _stands_alone(self, comment: Comment) -> bool:
        """Whether nothing stands before a comment on its line in the source."""
        start = self._text.rfind("\n", 0, comment.span.start) + 1
        return not self._text[start : comment.span.start].lstrip("\ufeff").strip()
