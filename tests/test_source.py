"""Source texts: their lines, with any kind of line break, and their kinds."""

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


def test_another_text_keeps_name_kind_and_location() -> None:
    file = SourceFile("levels/a.tltl", "a")
    assert (file.kind, file.location) == ("file", "levels/a.tltl")
    assert file.with_text("b") == SourceFile("levels/a.tltl", "b")
    text = SourceFile("<untitled:a>", "a", "text", "untitled:a")
    assert text.with_text("b") == SourceFile("<untitled:a>", "b", "text", "untitled:a")
    assert text != SourceFile("<untitled:a>", "a"), "a text is not a file of the same name"
