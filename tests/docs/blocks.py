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
    """A block, the word behind its fence, and the line that it begins on."""

    kind: str
    text: str
    line: int

    @property
    def file(self) -> str:
        """The name of the file that the block is: its first line may say it."""
        named = _FILE.match(self.text)
        return named[1] if named else "example.tltl"


def blocks(page: Path) -> list[Block]:
    text = page.read_text(encoding="utf-8")
    return [Block(found[1], found[2], text.count("\n", 0, found.start()) + 1) for found in _FENCE.finditer(text)]
