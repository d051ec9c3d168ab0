"""Convert the bound of an operator from words to brackets, or back, if both mean the same."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Final

from tltlc.core.record import record
from tltlc.grammar import tree

_STEPS: Final = (None, "step", "steps")
_WHOLE: Final = re.compile("[0-9]{1,9}")
_WORD: Final = {"F": "within", "G": "for", "X": "after", "N": "after", "once": "within", "historically": "for"}


@record
class Number:
    """The text of a number: ``3 s`` has the digits ``3`` and the unit ``s``. The unit may be empty."""

    digits: str
    unit: str = ""

    def __str__(self) -> str:
        return f"{self.digits} {self.unit}" if self.unit else self.digits


def bound_forms(node: tree.Unary, number: Callable[[tree.NumberExpr], Number]) -> dict[str, str]:
    """Return the texts of the bound of an operator, by the names ``words`` and ``brackets``.

    For ``eventually[0,3] a``, they are ``{"words": "within 3 steps", "brackets": "[0,3]"}``. The
    result is empty if the operator has no bound, or one that it may not have. It has only the form of
    the source if the other form cannot express the bound.

    ``for 3 steps`` gives the number of samples, and ``[0,2]`` the offset of the last one, so both
    mean the same. A time is rounded up to samples, so ``for`` with a time cannot be written in
    brackets. Neither can ``after``, or the bound of an operator about the past. ``within 2 s`` is
    always in words, since brackets need a fixed clock, and another file may declare the clock.
    ``number`` returns a number as the source spells it.
    """
    bound = node.bound
    if bound is None or node.op not in _WORD:
        return {}
    high = number(bound.high)
    if bound.words:
        texts = {"words": f"{_WORD[node.op]} {high}"}
        last = _in_brackets(node.op, high) if bound.high.unit in _STEPS else None
        return {**texts, "brackets": f"[0,{last}]"} if last else texts
    assert bound.low is not None
    low = number(bound.low)
    # With units, a space makes the comma visible.
    comma = ", " if bound.low.unit else ","
    texts = {"brackets": f"[{low}{comma}{high}]"}
    if bound.low.value or bound.low.unit not in _STEPS:
        return texts
    phrase = _in_words(node.op, bound.high, high)
    if phrase is None:
        return texts
    words = {"words": f"{_WORD[node.op]} {phrase}"}
    return {**texts, **words} if bound.high.unit in _STEPS else words


def _in_brackets(op: str, number: Number) -> str | None:
    """Convert a bound of some steps in words to brackets; return the upper end of the brackets.

    ``number`` is the text after ``within`` or ``for``. For ``within 3 steps`` return ``3``, and for
    ``for 3 steps`` return ``2``. Return None if no brackets mean the same.
    """
    count = number.digits
    if op == "F":
        return count
    return str(int(count) - 1) if op == "G" and _WHOLE.fullmatch(count) and int(count) else None


def _in_words(op: str, high: tree.NumberExpr, number: Number) -> str | None:
    """Convert the bound ``[0,high]`` to words; return the number and unit after ``within`` or ``for``.

    ``number`` is the text of ``high``. For ``F[0,3]`` return ``3 steps``, and for ``G[0,3]`` return
    ``4 steps``. Return None if no words mean the same.
    """
    if high.unit not in _STEPS:
        return str(number) if op == "F" else None
    count = number.digits
    if op == "G":
        if not _WHOLE.fullmatch(count):
            return None
        count = str(int(count) + 1)
    return f"{count} {'step' if count == '1' else 'steps'}"
