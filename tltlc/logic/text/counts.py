"""Print counts of steps in the texts of formulas: each as a number, or for two formulas as a range.

``F[0,39…2] p`` is one text for ``F[0,39] p`` and ``F[0,2] p``.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from typing import Final

from tltlc.logic.formula import Formula


class CountPrinter:
    """Prints the counts of steps in the text of a formula, such as the 9 in ``F[0,9] p``, as numbers.

    The functions that print formulas call it once for each count, always in the same order.
    Subclasses print counts in other ways.
    """

    def number(self, count: int) -> str:
        """Return the text of a count."""
        return str(count)

    def steps(self, count: int) -> str:
        """Return the text of a count with its noun: ``1 step``, ``9 steps``."""
        return f"{self.number(count)} step{'s' * (count > 1)}"

    def time(self, count: int) -> str:
        """Return the text of a count that is the time of a bound, as in "within 9 steps"."""
        return self.steps(count)


NUMBERS: Final = CountPrinter()


class TimePrinter(CountPrinter):
    """Prints the times of bounds in seconds if they are whole or half ones; ``clock_s`` is the length of a step."""

    def __init__(self, clock_s: float) -> None:
        self._clock_s = clock_s

    def time(self, count: int) -> str:
        """Return the text of a time: ``5 s``, or ``9 steps``."""
        halves = round(2 * count * self._clock_s)
        # On a fast clock, a rounded time would not tell the steps apart.
        is_exact = abs(halves / 2 / self._clock_s - count) < 1e-3
        return f"{halves / 2:g} s" if is_exact else self.steps(count)


class _CountCollector(CountPrinter):
    """Prints ``…`` in place of each count, and collects the counts in ``counts``."""

    def __init__(self) -> None:
        self.counts: list[int] = []

    def number(self, count: int) -> str:
        self.counts.append(count)
        return "…"

    def steps(self, count: int) -> str:
        return f"{self.number(count)} steps"


class _RangePrinter(CountPrinter):
    """Prints each count as a range to the next number in ``ends``: ``39…2`` for 39 if that number is 2."""

    def __init__(self, ends: Sequence[int]) -> None:
        self._ends = iter(ends)

    def number(self, count: int) -> str:
        return number_range(count, next(self._ends))

    def steps(self, count: int) -> str:
        text = self.number(count)
        return f"{text} step{'s' * (text != '1')}"


def number_range(first: int, last: int) -> str:
    """Return the text of a range: ``39…2`` for 39 and 2, and ``2`` if both numbers are 2."""
    return str(first) if first == last else f"{first}…{last}"


def range_text(first: Formula, last: Formula, write: Callable[[Formula, CountPrinter], str]) -> str | None:
    """Return one text for two formulas: ``F[0,39…2] p`` for ``F[0,39] p`` and ``F[0,2] p``.

    ``write`` prints a formula. Returns None if the formulas differ in more than the counts that are
    printed.
    """
    collectors = _CountCollector(), _CountCollector()
    if write(first, collectors[0]) != write(last, collectors[1]):
        return None
    return write(first, _RangePrinter(collectors[1].counts))


def foreign_range_text(first: str, last: str) -> str | None:
    """Return one text for two texts that are not formulas: ``wait 5…2`` for ``wait 5`` and ``wait 2``.

    The labels of imported automata may be such texts. Returns None if the texts differ in more than
    numbers.
    """
    parts, last_parts = re.split(r"(\d+)", first), re.split(r"(\d+)", last)
    if parts[::2] != last_parts[::2]:
        return None
    return "".join(one if one == other else f"{one}…{other}" for one, other in zip(parts, last_parts, strict=True))
