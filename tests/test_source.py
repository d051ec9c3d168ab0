"""Lines of source texts, with any kind of line break."""

from __future__ import annotations

import pytest

from tltlc.core.source import SourceFile, Span


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"], ids=["LF", "CR LF", "CR"])
def test_every_line_break_separates_lines(end: str) -> None:
    source = SourceFile("a.tltl", end.join(["one", "two", "three"]))
    assert [source.line(number) for number in (1, 2, 3)] == ["one", "two", "three"]
    start = source.text.index("three")
    assert source.position(start) == (3, 1)
    assert start == 2 * (3 + len(end)), "offsets are those of the file"
    assert source.slice(Span(start, start + 5)) == "three"


def test_mixed_line_breaks_each_end_a_line() -> None:
    source = SourceFile("a.tltl", "a\r\rb\r\n\nc\r")
    assert [source.line(number) for number in range(1, 7)] == ["a", "", "b", "", "c", ""]
