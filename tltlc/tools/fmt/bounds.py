"""Convert bounds between words and brackets where both mean exactly the same."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Final

from tltlc.grammar import tree

_STEPS: Final = (None, "step", "steps")
_WHOLE: Final = re.compile("[0-9]{1,9}")
_WORD: Final = {"F": "within", "G": "for", "X": "after", "N": "after"}


def forms(node: tree.Unary, number: Callable[[tree.NumberExpr], str]) -> dict[str, str]:
    """Return the forms of an operator's bound, by the names ``words`` and ``brackets``.

    Words look like ``within 3 steps``, brackets like ``[0,3]``. A bound may have only one of these
    forms. ``number`` returns the text of a number. The words of ``for`` count samples, and brackets
    name the last sample. A time is rounded up to samples, so the two forms differ and ``for`` with
    a time has only one. ``after`` has no brackets.
    """
    bound = node.bound
    if bound is None:
        return {}
    high = number(bound.high)
    if bound.words:
        texts = {"words": f"{_WORD[node.op]} {high}"}
        last = _in_brackets(node.op, bound.high, high)
        return {**texts, "brackets": f"[0,{last}]"} if last else texts
    assert bound.low is not None
    low = number(bound.low)
    # With units, a space makes the comma visible.
    comma = ", " if bound.low.unit else ","
    texts = {"brackets": f"[{low}{comma}{high}]"}
    if bound.low.value or bound.low.unit not in _STEPS:
        return texts
    phrase = _in_words(node.op, bound.high, high)
    return {**texts, "words": f"{_WORD[node.op]} {phrase}"} if phrase else texts


def _in_brackets(op: str, high: tree.NumberExpr, text: str) -> str | None:
    """Return the last sample of ``within`` or ``for`` as it appears in brackets, or None."""
    if high.unit not in _STEPS:
        return text if op == "F" else None
    count = text.partition(" ")[0]
    if op == "F":
        return count
    return str(int(count) - 1) if op == "G" and _WHOLE.fullmatch(count) and int(count) else None


def _in_words(op: str, high: tree.NumberExpr, text: str) -> str | None:
    """Return the words of ``within`` or ``for`` for a bound from now until ``high``, or None."""
    if high.unit not in _STEPS:
        return text if op == "F" else None
    count = text.partition(" ")[0]
    if op == "G":
        if not _WHOLE.fullmatch(count):
            return None
        count = str(int(count) + 1)
    return f"{count} {'step' if count == '1' else 'steps'}"
