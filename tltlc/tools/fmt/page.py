"""The page that the formatter fills with code, and with the comments of the source in between."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from tltlc.core.source import SourceFile, Span
from tltlc.grammar.module import Comment

WIDTH: Final = 100
"""The most columns of a line. Only a long word or a comment can make a line longer."""

STEP: Final = 4
"""The number of columns of one level of indentation."""

_DEEPEST: Final = 60
"""The largest indentation. A deeper one would leave no room for code."""

_GAP: Final = 2
"""The number of blanks between a line and the comment after it."""

_OPENERS: Final = ("{", "(", ":", "=")
"""If a line ends with one of these, the comment after it is not aligned with the comments below.

Such a comment is about the lines that follow, not about its own line.
"""


class Page:
    """Lines that are filled from left to right, with the comments in the order of the source.

    A comment after code stays after code. A comment on a line of its own stays on a line of its own.
    """

    def __init__(self, source: SourceFile, comments: Sequence[Comment]) -> None:
        self._text = source.text
        self._comments = comments
        self._next = 0
        self._lines: list[str] = []
        self._line_comments: dict[int, str] = {}
        self._is_comment = False
        self._at_line_start = True
        self._indent = 0
        self._opened = 0

    def put(self, text: str) -> None:
        """Append a text to the current line, or begin a new line with it if that line has ended."""
        if self._at_line_start:
            self._lines.append(" " * self._indent + text.lstrip(" "))
            self._at_line_start = self._is_comment = False
        else:
            self._lines[-1] += text

    def end_line(self, indent: int) -> None:
        """End the current line. The next text begins a new line, at the column ``indent``."""
        self._at_line_start = True
        self._indent = min(indent, _DEEPEST)

    def begin(self, joined: bool, indent: int) -> None:
        """Begin a new line, or with ``joined``, write a space and continue the current line.

        If the current line has already ended, this always begins a new line.
        """
        if joined and not self._at_line_start:
            self.put(" ")
        else:
            self.end_line(indent)

    def put_source(self, span: Span) -> None:
        """Copy a part of the source, with its comments."""
        while self.has_comment(span.end):
            self._next += 1
        first, *rest = (line.rstrip() for line in self._text[span.start : span.end].split("\n"))
        self.put(first)
        for place, line in enumerate(rest):
            if line or rest[place - 1]:
                self._lines.append(line)

    def open_block(self) -> None:
        """Mark the beginning of a block, so that no empty line is written directly after it."""
        self._opened = len(self._lines)

    @property
    def is_at_line_start(self) -> bool:
        """Whether the next text begins a line."""
        return self._at_line_start

    @property
    def room(self) -> int:
        """The number of columns that are left in the line."""
        return WIDTH - (self._indent if self._at_line_start else len(self._lines[-1]))

    @property
    def indent(self) -> int:
        """The indentation of the current line, or of the next line if the current one has ended."""
        if self._at_line_start:
            return self._indent
        line = self._lines[-1]
        return len(line) - len(line.lstrip(" "))

    def has_comment(self, end: int, start: int = 0) -> bool:
        """Whether the source has a comment between these offsets that is not written yet."""
        for place in range(self._next, len(self._comments)):
            offset = self._comments[place].span.start
            if offset >= start:
                return offset < end
        return False

    def find(self, sign: str, start: int) -> int:
        """Return the offset of the first ``sign`` in the source at or after ``start``; -1 if there is none.

        Comments that are not written yet are skipped.
        """
        place = self._text.find(sign, start)
        for number in range(self._next, len(self._comments)):
            span = self._comments[number].span
            if span.start > place:
                break
            if place < span.end:
                place = self._text.find(sign, span.end)
        return place

    def put_comments(self, end: int, indent: int, *, gaps: bool = False) -> None:
        """Write the comments that precede the offset ``end`` in the source and are not written yet.

        Comments on lines of their own, and the text after a comment, begin at the column ``indent``.
        With ``gaps``, an empty line before a comment is kept.
        """
        while self._next < len(self._comments) and self._comments[self._next].span.start < end:
            comment = self._comments[self._next]
            self._next += 1
            if self._lines and not self._is_comment and not self._stands_alone(comment):
                self._line_comments[len(self._lines) - 1] = comment.text
            else:
                if gaps:
                    self.put_gap(comment.span.start)
                self._lines.append(" " * min(indent, _DEEPEST) + comment.text)
            self._is_comment = True
            self.end_line(indent)

    def put_gap(self, offset: int) -> None:
        """Write an empty line if the source has an empty line before this offset."""
        start = offset
        while start and self._text[start - 1].isspace():
            start -= 1
        if len(self._lines) > self._opened and self._text.count("\n", start, offset) > 1:
            self._lines.append("")

    def text(self) -> str:
        """Return the finished page. Comments after neighbouring lines are aligned; each line has a line feed."""
        lines = [line.rstrip() for line in self._lines]
        group: list[int] = []
        for place in sorted(self._line_comments):
            if group and (place != group[-1] + 1 or lines[group[-1]].endswith(_OPENERS)):
                self._align(lines, group)
                group = []
            group.append(place)
        self._align(lines, group)
        return "".join(f"{line}\n" for line in lines)

    def _align(self, lines: list[str], group: list[int]) -> None:
        """Append to each line of a group the comment that belongs after it; change ``lines`` in place.

        ``group`` has the indices of the lines. The comments begin in the same column, unless one of
        them would then end beyond ``WIDTH``.
        """
        widest = max((len(lines[place]) for place in group), default=0)
        if any(widest + _GAP + len(self._line_comments[place]) > WIDTH for place in group):
            widest = 0
        for place in group:
            lines[place] = lines[place].ljust(widest) + " " * _GAP + self._line_comments[place]

    def _stands_alone(self, comment: Comment) -> bool:
        """Whether a comment is alone on its line in the source."""
        start = self._text.rfind("\n", 0, comment.span.start) + 1
        return not self._text[start : comment.span.start].lstrip("\ufeff").strip()
