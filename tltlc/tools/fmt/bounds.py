"""Convert a bound from words to brackets, or back, if both forms mean exactly the same."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Final

from tltlc.grammar import tree

_STEPS: Final = (None, "step", "steps")
_WHOLE: Final = re.compile("[0-9]{1,9}")
_WORD: Final = {"F": "within", "G": "for", "X": "after", "N": "after"}


def bound_forms(node: tree.Unary, number: Callable[[tree.NumberExpr], str]) -> dict[str, str]:
    """Return the bound of an operator in two forms, by the names ``words`` and ``brackets``.

    Words look like ``within 3 steps``, and brackets like ``[0,3]``. The result is empty if there is
    no bound. It lacks a form that cannot express the bound:

    - ``for 3 steps`` counts samples, and ``[0,2]`` names the last one, so each expresses the other;
    - no brackets equal ``for`` with a time, because a time is rounded up to samples;
    - no brackets equal ``after``.

    ``number`` returns the text of a number.
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
    """Return the end with which ``[0,END]`` equals ``within`` or ``for``; None if none does."""
    if high.unit not in _STEPS:
        return text if op == "F" else None
    count = text.partition(" ")[0]
    if op == "F":
        return count
    return str(int(count) - 1) if op == "G" and _WHOLE.fullmatch(count) and int(count) else None


def _in_words(op: str, high: tree.NumberExpr, text: str) -> str | None:
    """Return the bound with which ``within`` or ``for`` equals ``[0,high]``; None if none does."""
    if high.unit not in _STEPS:
        return text if op == "F" else None
    count = text.partition(" ")[0]
    if op == "G":
        if not _WHOLE.fullmatch(count):
            return None
        count = str(int(count) + 1)
    return f"{count} {'step' if count == '1' else 'steps'}"
