"""The fenced blocks of a page of the documentation."""

from __future__ import annotations

import re
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"

_FENCE = re.compile(r"^```(\w*)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
_FILE = re.compile(r"// (\w+\.tltl)\n")


class Block(NamedTuple):
    """A block: the word after its fence, its text, and the number of its first line."""

    kind: str
    text: str
    line: int

    @property
    def file(self) -> str:
        """The name of the block's file, which may be given in a comment on its first line."""
        named = _FILE.match(self.text)
        return named[1] if named else "example.tltl"


def blocks(page: Path) -> list[Block]:
    text = page.read_text(encoding="utf-8")
    return [Block(fence[1], fence[2], text.count("\n", 0, fence.start()) + 1) for fence in _FENCE.finditer(text)]
