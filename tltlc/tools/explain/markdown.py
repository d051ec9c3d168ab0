"""Write an explanation as Markdown."""

from __future__ import annotations

import re
from collections.abc import Iterator

from tltlc.tools.explain.explanation import Explanation
from tltlc.tools.explain.sections import Section, SectionList, sections


def markdown(explanation: Explanation) -> str:
    """Return the explanation as Markdown, with a newline at the end."""
    lines: list[str] = []
    for number, section in enumerate(sections(explanation)):
        lines += [f"{'##' if number else '#'} {_escape(section.heading)}", ""]
        lines += _blocks(section)
    return "\n".join(lines).rstrip("\n") + "\n"


def _blocks(section: Section) -> Iterator[str]:
    for block in section.blocks:
        if isinstance(block, str):
            yield from (_escape(block), "")
        elif isinstance(block, SectionList):
            yield from (block.title, "") if block.title else ()
            marks = (f"{number}." if block.numbered else "-" for number in range(1, len(block.items) + 1))
            yield from (f"{mark} {_escape(item)}" for mark, item in zip(marks, block.items, strict=True))
            yield ""
        else:
            rows = (block.header, ("---",) * len(block.header), *(tuple(map(_escape, row)) for row in block.rows))
            yield from (f"| {' | '.join(row)} |" for row in rows)
            yield ""


def _escape(text: str) -> str:
    """Return the text on one line, with a backslash before each character special to Markdown."""
    return re.sub(r"([\\`*_|<>\[\]])", r"\\\1", " ".join(text.split()))
