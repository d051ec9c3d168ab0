"""Bounds in words and in brackets, each where it says exactly the same."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Final

from tltlc.grammar import tree

_STEPS: Final = (None, "step", "steps")
_WHOLE: Final = re.compile("[0-9]{1,9}")
_WORD: Final = {"F": "within", "G": "for", "X": "after", "N": "after"}


def forms(node: tree.Unary, number: Callable[[tree.Number], str]) -> dict[str, str]:
    """The bound of an operator as ``words`` (``within 3 steps``) and as ``brackets`` (``[0,3]``), where it has both.

    ``number`` gives the text of a number.  Words count the samples of ``for``, and brackets name the last one, so a
    time, which is rounded up to samples, has no second form there.  ``after`` has no brackets at all.
    """
    bound = node.bound
    if bound is None:
        return {}
    high = number(bound.high)
    if bound.words:
        found = {"words": f"{_WORD[node.op]} {high}"}
        last = _in_brackets(node.op, bound.high, high)
        return {**found, "brackets": f"[0,{last}]"} if last else found
    assert bound.low is not None
    low = number(bound.low)
    # With units, the comma needs its space to be seen.
    comma = ", " if bound.low.unit else ","
    found = {"brackets": f"[{low}{comma}{high}]"}
    if bound.low.value or bound.low.unit not in _STEPS:
        return found
    said = _in_words(node.op, bound.high, high)
    return {**found, "words": f"{_WORD[node.op]} {said}"} if said else found


def _in_brackets(op: str, high: tree.Number, text: str) -> str | None:
    """The last sample of ``within`` or ``for``, as brackets name it, or None where they cannot."""
    if high.unit not in _STEPS:
        return text if op == "F" else None
    count = text.partition(" ")[0]
    if op == "F":
        return count
    return str(int(count) - 1) if op == "G" and _WHOLE.fullmatch(count) and int(count) else None


def _in_words(op: str, high: tree.Number, text: str) -> str | None:
    """What ``within`` or ``for`` says of a bound that begins now and ends at ``high``, or None."""
    if high.unit not in _STEPS:
        return text if op == "F" else None
    count = text.partition(" ")[0]
    if op == "G":
        if not _WHOLE.fullmatch(count):
            return None
        count = str(int(count) + 1)
    return f"{count} {'step' if count == '1' else 'steps'}"
