"""The page that the formatter writes: code with the comments of the source in their places."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from tltlc.core.source import SourceFile, Span
from tltlc.grammar.tree import Comment

WIDTH: Final = 100
"""The maximum number of columns in a line, if its words and comments allow it."""

STEP: Final = 4
"""The number of columns of one level of indentation."""

_DEEPEST: Final = 60
"""The largest indentation. A deeper one would leave no room for code."""

_GAP: Final = 2
"""The number of blanks between a line and the comment after it."""

_OPENERS: Final = ("{", "(", ":", "=")
"""Line ends after which a comment applies to everything that follows, not only to the next line."""


class Page:
    """Lines that are filled from left to right. Comments join them in the order of the source.

    A comment after code stays after it. A comment on its own line stays on its own line.
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
        """Write a text, on a new line if the last line has ended."""
        if self._fresh:
            self._lines.append(" " * self._indent + text.lstrip(" "))
            self._fresh = self._is_comment = False
        else:
            self._lines[-1] += text

    def end_line(self, indent: int) -> None:
        """End the line. The next text begins a line at ``indent``."""
        self._fresh = True
        self._indent = min(indent, _DEEPEST)

    def begin(self, joined: bool, indent: int) -> None:
        """Begin a line, or continue this line if ``joined`` and it does not end in a comment."""
        if joined and not self._fresh:
            self.put(" ")
        else:
            self.end_line(indent)

    def put_as_written(self, span: Span) -> None:
        """Write a part of the source, with its comments, as it is in the source."""
        while self.has_comment(span.end):
            self._next += 1
        first, *rest = (line.rstrip() for line in self._text[span.start : span.end].split("\n"))
        self.put(first)
        for place, line in enumerate(rest):
            if line or rest[place - 1]:
                self._lines.append(line)

    def open_block(self) -> None:
        """Note that a block begins here, so that no empty line follows."""
        self._opened = len(self._lines)

    @property
    def is_fresh(self) -> bool:
        """Whether the next text begins a line."""
        return self._fresh

    @property
    def room(self) -> int:
        """The number of columns that are left in the line."""
        return WIDTH - (self._indent if self._fresh else len(self._lines[-1]))

    @property
    def indent(self) -> int:
        """The column where the line begins."""
        if self._fresh:
            return self._indent
        line = self._lines[-1]
        return len(line) - len(line.lstrip(" "))

    def has_comment(self, end: int, start: int = 0) -> bool:
        """Whether an unwritten comment begins before ``end`` and not before ``start``."""
        for place in range(self._next, len(self._comments)):
            at = self._comments[place].span.start
            if at >= start:
                return at < end
        return False

    def find(self, sign: str, start: int) -> int:
        """Return the first place of a sign from an offset of the source on.

        Comments that are not yet written are skipped.
        """
        place = self._text.find(sign, start)
        for number in range(self._next, len(self._comments)):
            span = self._comments[number].span
            if span.start > place:
                break
            if place < span.end:
                place = self._text.find(sign, span.end)
        return place

    def comments(self, end: int, indent: int, *, gaps: bool = False) -> None:
        """Write the comments before an offset. They and the next text begin lines at ``indent``.

        With ``gaps``, empty lines before comments are kept.
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
        """Write an empty line if the source has any before this offset."""
        start = offset
        while start and self._text[start - 1].isspace():
            start -= 1
        if len(self._lines) > self._opened and self._text.count("\n", start, offset) > 1:
            self._lines.append("")

    def text(self) -> str:
        """Return all lines, each with a line feed.

        Comments after neighbouring lines are aligned.
        """
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
        """Write comments after their lines.

        They share one column unless one of them would then end beyond ``WIDTH``.
        """
        widest = max((len(lines[place]) for place in group), default=0)
        if any(widest + _GAP + len(self._remarks[place]) > WIDTH for place in group):
            widest = 0
        for place in group:
            lines[place] = lines[place].ljust(widest) + " " * _GAP + self._remarks[place]

    def _stands_alone(self, comment: Comment) -> bool:
        """Whether a comment is alone on its line in the source."""
        start = self._text.rfind("\n", 0, comment.span.start) + 1
        return not self._text[start : comment.span.start].lstrip("\ufeff").strip()
