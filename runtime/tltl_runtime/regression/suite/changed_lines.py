"""Describe which lines of a text file have changed, for example ``line 12, lines 40 to 41``."""

from __future__ import annotations

from collections.abc import Iterator
from difflib import SequenceMatcher
from typing import Final

from tltl_runtime.support.number_text import short_list

_MOST_PARTS: Final = 3
"""At most this many parts of a file are named. Further parts are counted."""

_MOST_PAIRS: Final = 1_000_000
"""Texts are compared line by line if the numbers of their different lines, multiplied, are at most this."""


def changed_lines(before: str, now: str) -> str:
    """Describe the lines that differ between two texts, by their numbers in the text ``now``, from 1.

    Empty if no line differs.
    """
    old, new = before.split("\n"), now.split("\n")
    start = next((row for row, (a, b) in enumerate(zip(old, new, strict=False)) if a != b), min(len(old), len(new)))
    rest = min(len(old), len(new)) - start
    end = next((row for row in range(rest) if old[-1 - row] != new[-1 - row]), rest)
    old, new = old[start : len(old) - end], new[start : len(new) - end]
    if len(old) * len(new) > _MOST_PAIRS:
        return _lines_text(start, start + len(new))
    return short_list(list(_parts(old, new, start)), _MOST_PARTS)


def _parts(old: list[str], new: list[str], start: int) -> Iterator[str]:
    """Yield a text for each run of lines that differs. ``start`` lines come before the first of ``new``."""
    for kind, low, high, first, last in SequenceMatcher(None, old, new, autojunk=False).get_opcodes():
        if kind == "delete":
            count = high - low
            place = f"after line {start + first}" if start + first else "at the start"
            yield f"{count} line{'s' * (count != 1)} removed {place}"
        elif kind != "equal":
            yield _lines_text(start + first, start + last)


def _lines_text(first: int, last: int) -> str:
    """Return the numbers of the lines after the first ``first`` ones, up to the line ``last``."""
    return f"line {last}" if last == first + 1 else f"lines {first + 1} to {last}"
