"""Write an explanation as plain text, at most 100 columns wide unless a word is longer."""

from __future__ import annotations

from collections.abc import Iterator
from textwrap import wrap

from tltlc.tools.explain.explanation import Explanation
from tltlc.tools.explain.sections import Section, SectionList, SectionTable, sections

_WIDTH = 100
_GAP = "  "
_NARROWEST = 16


def text(explanation: Explanation) -> str:
    """Return the explanation as text, with a newline at the end."""
    lines: list[str] = []
    for number, section in enumerate(sections(explanation)):
        lines += [*([""] if number else []), section.heading, *(["=" * len(section.heading)] if not number else [])]
        lines += _blocks(section)
    return "\n".join([*lines, ""])


def _blocks(section: Section) -> Iterator[str]:
    for block in section.blocks:
        if isinstance(block, str):
            yield from _wrap(block, _WIDTH, initial_indent=_GAP, subsequent_indent=_GAP)
        elif isinstance(block, SectionList):
            yield from _list(block)
        else:
            yield from _table(block)


def _list(block: SectionList) -> Iterator[str]:
    indent = _GAP
    if block.title:
        yield f"{_GAP}{block.title}"
        indent += _GAP
    for number, item in enumerate(block.items, start=1):
        mark = f"{number}. ".rjust(len(f"{len(block.items)}. ")) if block.numbered else "- "
        yield from _wrap(item, _WIDTH, initial_indent=indent + mark, subsequent_indent=indent + " " * len(mark))


def _table(table: SectionTable) -> Iterator[str]:
    """Yield the lines of a table.

    All columns but the last two are as wide as their widest cell. The last two share the rest of the
    line, and their cells are wrapped if necessary.
    """
    rows = (table.header, *table.rows)
    widths = [max(len(row[column]) for row in rows) for column in range(len(table.header))]
    left = _WIDTH - len(_GAP) * len(widths) - sum(widths[:-2])
    if sum(widths[-2:]) > left:
        # The last column gets what the one before it leaves, or almost half, but no more than it
        # needs.
        last = min(widths[-1], max(left - widths[-2], left // 2 - _NARROWEST // 2))
        widths[-2:] = [left - last, last]
    for row in rows:
        cells = [_wrap(cell, width) or [""] for cell, width in zip(row, widths, strict=True)]
        for line in range(max(map(len, cells))):
            parts = [cell[line] if line < len(cell) else "" for cell in cells]
            padded = (part.ljust(width) for part, width in zip(parts, widths, strict=True))
            yield (_GAP + _GAP.join(padded)).rstrip()


def _wrap(text: str, width: int, initial_indent: str = "", subsequent_indent: str = "") -> list[str]:
    return wrap(
        text,
        width,
        initial_indent=initial_indent,
        subsequent_indent=subsequent_indent,
        break_long_words=False,
        break_on_hyphens=False,
    )
