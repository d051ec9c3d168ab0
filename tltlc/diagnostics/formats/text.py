"""Diagnostics for people: title, place, the line with a caret under it, one way out."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from tltlc.diagnostics.diagnostic import Diagnostic, Label

_BOLD: Final = "1"
_DIM: Final = "2"
_COLOURS: Final = {"error": "1;31", "warning": "1;33", "note": "1;36"}
_TAB: Final = 4
_WIDTH: Final = 160
"""Columns of source text that are shown; of a longer line, a part around the place."""


def render(diagnostics: Sequence[Diagnostic], *, color: bool = False) -> str:
    """The diagnostics one below the other, an empty line between them."""
    return "\n".join(_one(diagnostic, color) for diagnostic in diagnostics)


def _one(diagnostic: Diagnostic, color: bool) -> str:
    colour = _COLOURS[diagnostic.severity]
    head = _paint(f"{diagnostic.severity}[{diagnostic.code}]", colour, color)
    lines = [f"{head}: {_paint(visible(diagnostic.title), _BOLD, color)}"]
    numbers = [label.source.position(label.span.start)[0] for label in diagnostic.labels]
    gutter = max((len(str(number)) for number in numbers), default=0)
    for place, label in enumerate(diagnostic.labels):
        lines += _place(label, gutter, colour if place == 0 else _COLOURS["note"], color)
    if diagnostic.help:
        first, *rest = diagnostic.help.splitlines()
        lines.append(f"  {_paint('help:', _BOLD, color)} {visible(first)}")
        lines += [f"        {visible(line)}" for line in rest]
    return "\n".join(lines) + "\n"


def _place(label: Label, gutter: int, colour: str, color: bool) -> list[str]:
    """Where a label points: file, line and column; the line; the caret with the label's remark."""
    source, span = label.source, label.span
    number, column = source.position(span.start)
    last, _ = source.position(max(span.start, span.end - 1))
    line = source.line(number)
    length = max(1, len(line) - column + 1 if last > number else span.end - span.start)
    shown, start, width = _window(line, column - 1, length)
    remark = [_paint("^" * width, colour, color)]
    if last > number:
        remark.append(f"(to line {last})")
    if label.message:
        remark.append(_paint(visible(label.message), colour, color))
    bar = _paint("|", _DIM, color)
    return [
        _paint(f"  {visible(source.name)}:{number}:{column}", _DIM, color),
        f"{_paint(str(number).rjust(gutter), _DIM, color)} {bar} {shown}".rstrip(),
        f"{' ' * gutter} {bar} {' ' * start}{' '.join(remark)}",
    ]


def _window(line: str, start: int, length: int) -> tuple[str, int, int]:
    """A line as it is shown, and the columns where the caret starts and how many it takes."""
    # No more of a part is shown than this, and a line may be a megabyte long.
    end = start + length
    parts = (
        line[max(0, start - _WIDTH) : start],
        line[start : min(end, start + _WIDTH + 1)],
        line[end : end + _WIDTH + 1],
    )
    before, marked, after = map(_expand, parts)
    # A tab is as wide as its place asks, so the part before it must be measured first.
    before = _expand_tabs(before, 0)
    marked = _expand_tabs(marked, columns(before))
    after = _expand_tabs(after, columns(before) + columns(marked))
    if len(before) + len(marked) + len(after) > _WIDTH:
        before = before if len(before) <= _WIDTH // 2 else f"…{before[1 - _WIDTH // 2 :]}"
        marked = marked if len(marked) <= _WIDTH // 2 else f"{marked[: _WIDTH // 2 - 1]}…"
        room = max(1, _WIDTH - len(before) - len(marked))
        after = after if len(after) <= room else f"{after[: room - 1]}…"
    return before + marked + after, columns(before), max(1, columns(marked))


def _expand(text: str) -> str:
    """A part of a line, with signs that cannot be shown replaced; tabs stay."""
    return "\t".join(visible(piece) for piece in text.split("\t"))


def _expand_tabs(text: str, column: int) -> str:
    """A part of a line that begins at a column, with spaces in place of tabs."""
    first, *rest = text.split("\t")
    shown = first
    for piece in rest:
        shown += " " * (_TAB - (column + columns(shown)) % _TAB) + piece
    return shown


def visible(text: str) -> str:
    """A text with a replacement for each sign that could not be seen, or would steer the terminal."""
    return text if text.isprintable() else "".join(sign if sign.isprintable() else "\ufffd" for sign in text)


def columns(text: str) -> int:
    """How many columns a terminal takes to show a text: two for wide signs, none for combining ones."""
    if text.isascii():
        return len(text)
    from unicodedata import combining, east_asian_width

    return sum(0 if combining(sign) else 2 if east_asian_width(sign) in "WF" else 1 for sign in text)


def _paint(text: str, colour: str, color: bool) -> str:
    return f"\x1b[{colour}m{text}\x1b[0m" if color else text
