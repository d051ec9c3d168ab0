"""The data that the playground page needs when it is loaded: examples, and words of the spec language."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final

from tltlc.grammar.tables import load

EXAMPLES: Final = Path(__file__).with_name("examples")


def start() -> dict[str, Any]:
    """Return the answer to ``{}``, the first request of the page.

    The answer contains the ``examples``, and the keywords (``words``) and ``units`` that the page
    colours.
    """
    tables = load()
    # A soft keyword is a name in most places, so it keeps the colour of a name.
    words = sorted(word for word in tables.words if word.isascii() and word not in tables.soft)
    return {"examples": examples(), "words": words, "units": sorted(tables.units)}


def examples() -> list[dict[str, str]]:
    """Return the example specs in order, each with its ``title`` (from the first line) and ``text``."""
    texts = [path.read_text(encoding="utf-8") for path in sorted(EXAMPLES.glob("*.tltl"))]
    return [{"title": text.partition("\n")[0].removeprefix("// "), "text": text} for text in texts]
