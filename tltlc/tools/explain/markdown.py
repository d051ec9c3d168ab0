"""Write an explanation as Markdown."""

from __future__ import annotations

import re
from collections.abc import Iterator

from tltlc.tools.explain.explanation import Explanation
from tltlc.tools.explain.sections import List, Section, document


def markdown(explained: Explanation) -> str:
    """Return the explanation as Markdown that ends with a newline."""
    lines: list[str] = []
    for number, section in enumerate(document(explained)):
        lines += [f"{'##' if number else '#'} {_plain(section.heading)}", ""]
        lines += _blocks(section)
    return "\n".join(lines).rstrip("\n") + "\n"


def _blocks(section: Section) -> Iterator[str]:
    for block in section.blocks:
        if isinstance(block, str):
            yield from (_plain(block), "")
        elif isinstance(block, List):
            yield from (block.title, "") if block.title else ()
            marks = (f"{number}." if block.numbered else "-" for number in range(1, len(block.items) + 1))
            yield from (f"{mark} {_plain(item)}" for mark, item in zip(marks, block.items, strict=True))
            yield ""
        else:
            rows = (block.header, ("---",) * len(block.header), *(tuple(map(_plain, row)) for row in block.rows))
            yield from (f"| {' | '.join(row)} |" for row in rows)
            yield ""


def _plain(words: str) -> str:
    """Return the text with the characters escaped that have a meaning in Markdown."""
    return re.sub(r"([\\`*_|<>\[\]])", r"\\\1", " ".join(words.split()))
