"""Diagnostics for people: title, place, the source line with a caret under it, and a suggestion."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from tltlc.diagnostics.diagnostic import Diagnostic, Label

_BOLD: Final = "1"
_DIM: Final = "2"
_COLOURS: Final = {"error": "1;31", "warning": "1;33", "note": "1;36"}
_TAB: Final = 4
_WIDTH: Final = 160
"""The most characters of a source line that are shown.

If a line is longer, only the part around the span is shown.
"""


def render(diagnostics: Sequence[Diagnostic], *, color: bool = False) -> str:
    """Return the diagnostics one below the other, with an empty line between them; ``color`` adds ANSI colours."""
    return "\n".join(_diagnostic_text(diagnostic, color) for diagnostic in diagnostics)


def _diagnostic_text(diagnostic: Diagnostic, color: bool) -> str:
    colour = _COLOURS[diagnostic.severity]
    head = _paint(f"{diagnostic.severity}[{diagnostic.code}]", colour, color)
    lines = [f"{head}: {_paint(replace_unprintable(diagnostic.title), _BOLD, color)}"]
    numbers = [label.source.position(label.span.start)[0] for label in diagnostic.labels]
    gutter = max((len(str(number)) for number in numbers), default=0)
    for index, label in enumerate(diagnostic.labels):
        lines += _label_lines(label, gutter, colour if index == 0 else _COLOURS["note"], color)
    if diagnostic.help:
        first, *rest = diagnostic.help.splitlines()
        lines.append(f"  {_paint('help:', _BOLD, color)} {replace_unprintable(first)}")
        lines += [f"        {replace_unprintable(line)}" for line in rest]
    return "\n".join(lines) + "\n"


def _label_lines(label: Label, gutter: int, colour: str, color: bool) -> list[str]:
    """Return three lines for a label: its place, the source line, and carets with the label's message.

    ``gutter`` is the width of the column of line numbers, in characters.
    """
    source, span = label.source, label.span
    number, column = source.position(span.start)
    last, _ = source.position(max(span.start, span.end - 1))
    line = source.line(number)
    length = max(1, len(line) - column + 1 if last > number else span.end - span.start)
    excerpt, start, width = _window(line, column - 1, length)
    marker = [_paint("^" * width, colour, color)]
    if last > number:
        marker.append(f"(to line {last})")
    if label.message:
        marker.append(_paint(replace_unprintable(label.message), colour, color))
    bar = _paint("|", _DIM, color)
    return [
        _paint(f"  {replace_unprintable(source.name)}:{number}:{column}", _DIM, color),
        f"{_paint(str(number).rjust(gutter), _DIM, color)} {bar} {excerpt}".rstrip(),
        f"{' ' * gutter} {bar} {' ' * start}{' '.join(marker)}",
    ]


def _window(line: str, start: int, length: int) -> tuple[str, int, int]:
    """Return the part of a line to show, the column of the first caret (from 0), and the number of carets.

    Carets mark ``length`` characters of the line, beginning at the index ``start``.
    """
    # A line may be a megabyte long, so first cut each part to the most that can be shown.
    end = start + length
    parts = (
        line[max(0, start - _WIDTH) : start],
        line[start : min(end, start + _WIDTH + 1)],
        line[end : end + _WIDTH + 1],
    )
    before, marked, after = map(_replace_except_tabs, parts)
    # The width of a tab depends on its column, so measure the part before it first.
    before = _expand_tabs(before, 0)
    marked = _expand_tabs(marked, columns(before))
    after = _expand_tabs(after, columns(before) + columns(marked))
    if len(before) + len(marked) + len(after) > _WIDTH:
        before = before if len(before) <= _WIDTH // 2 else f"…{before[1 - _WIDTH // 2 :]}"
        marked = marked if len(marked) <= _WIDTH // 2 else f"{marked[: _WIDTH // 2 - 1]}…"
        room = max(1, _WIDTH - len(before) - len(marked))
        after = after if len(after) <= room else f"{after[: room - 1]}…"
    return before + marked + after, columns(before), max(1, columns(marked))


def _replace_except_tabs(text: str) -> str:
    """Return a text with U+FFFD in place of all unprintable characters except tabs."""
    return "\t".join(replace_unprintable(piece) for piece in text.split("\t"))


def _expand_tabs(text: str, column: int) -> str:
    """Return a part of a line with spaces in place of tabs; ``column`` is where the part begins, from 0."""
    first, *rest = text.split("\t")
    expanded = first
    for piece in rest:
        expanded += " " * (_TAB - (column + columns(expanded)) % _TAB) + piece
    return expanded


def replace_unprintable(text: str) -> str:
    """Return a text with U+FFFD in place of its unprintable characters, which could control the terminal."""
    return (
        text
        if text.isprintable()
        else "".join(character if character.isprintable() else "\ufffd" for character in text)
    )


def columns(text: str) -> int:
    """Return how many columns of a terminal a text takes up: two for a wide character, none for a combining one."""
    if text.isascii():
        return len(text)
    from unicodedata import combining, east_asian_width

    return sum(0 if combining(character) else 2 if east_asian_width(character) in "WF" else 1 for character in text)


def _paint(text: str, colour: str, color: bool) -> str:
    return f"\x1b[{colour}m{text}\x1b[0m" if color else text
