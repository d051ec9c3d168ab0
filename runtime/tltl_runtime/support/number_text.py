"""Format numbers, lists and lines of text for people."""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil, floor, inf, log10
from textwrap import wrap
from typing import Final

WIDTH: Final = 80
"""The width of a terminal, in characters, at which lines are broken."""

_FEW: Final = 25
"""Up to this total, counts are shown without a percentage."""


def share(value: float, places: int = 2) -> str:
    """Return a number in [0, 1] with ``places`` decimals; only exactly 0 and 1 are shown as 0 and 1.

    With two decimals, for example, 0.999 becomes ``0.99``, and 0.001 becomes ``0.01``.
    """
    text, least = f"{value:.{places}f}", 10.0**-places
    if value < 1.0 <= float(text):
        return f"{1.0 - least:.{places}f}"
    return f"{least:.{places}f}" if float(text) == 0.0 < value else number(value, places)


def percent(value: float) -> str:
    """Return a number in [0, 1] in whole percent; only exactly 0 and 1 are shown as ``0%`` and ``100%``."""
    return f"{100.0 * float(share(value)):.0f}%"


def percent_exactly(value: float) -> str:
    """Return a number in [0, 1], such as a user's setting, in percent with up to six digits: ``99.9%``."""
    return f"{100.0 * value:g}%"


def count_text(count: int, total: int, noun: str = "", *, is_compared: bool = False) -> str:
    """Return a count out of a total, such as ``121 of 300 episodes (40%)`` or ``3 of 4``.

    The percentage is left out if the count is 0 or the total. It is also left out if the total is at most
    25, unless the count ``is_compared`` with one out of another total.
    """
    text = f"{count} of {total}{' ' * bool(noun)}{noun}"
    return f"{text} ({percent(count / total)})" if (is_compared or total > _FEW) and 0 < count < total else text


def quantity_text(value: float, unit: str, gap: float = inf) -> str:
    """Return a measured number with its unit, such as ``0.62 m`` or ``14.1``.

    There are at most two decimals and about three digits, or as many decimals as show a difference of
    ``gap``, up to six. A difference that six decimals do not show needs no more of them.
    """
    least = 2 if abs(value) < 10.0 else 1 if abs(value) < 100.0 else 0
    decimals = next((places for places in range(least, 7) if round(gap, places) != 0.0), least)
    return f"{number(value, decimals)}{' ' * bool(unit)}{unit}"


def interval_text(interval: tuple[float, float]) -> str:
    """Return an interval in [0, 1] in percent, rounded outwards to whole numbers: ``85% to 93%``."""
    return " to ".join(interval_texts(interval))


def interval_texts(interval: tuple[float, float]) -> tuple[str, str]:
    """Return the ends of an interval in [0, 1] in percent, rounded outwards to whole numbers."""
    return f"{floor(100.0 * interval[0] + 1e-9)}%", f"{ceil(100.0 * interval[1] - 1e-9)}%"


def significant(value: float, most: int = 6) -> str:
    """Return a number with three significant digits, but at most ``most`` decimals: ``5.70``, ``0.0123``, ``122``.

    Numbers from 1000 on are rounded, too: 12,345 becomes ``12,300``. Zero is ``0.00``, never ``-0``.
    """
    value = round(value, most)
    if value == 0.0:
        return "0.00"
    rounded = round(value, 2 - floor(log10(abs(value))))
    # Rounding may have added a digit: 9.996 is 10.0.
    decimals = 2 - floor(log10(abs(rounded)))
    return f"{rounded:,.{min(most, max(0, decimals))}f}"


def mean_text(value: float) -> str:
    """Return a mean of progress or reward, in [-1, 1], with three significant digits, but at most three decimals."""
    return significant(value, 3)


def number(value: float, places: int) -> str:
    """Return a number with ``places`` decimals, never ``-0``."""
    text = f"{value:.{places}f}"
    return text.lstrip("-") if float(text) == 0.0 else text


def duration(seconds: float) -> str:
    """Return a span of time for people: ``45 s``, ``12 min 5 s``, ``3 h 20 min``."""
    minutes, rest = divmod(round(seconds), 60)
    if not minutes:
        return f"{rest} s"
    hours, minutes = divmod(minutes, 60)
    return f"{hours} h {minutes} min" if hours else f"{minutes} min {rest} s"


def short_list(names: Sequence[str], most: int) -> str:
    """Return the first ``most`` names, and the number of names left out: ``a, b and 3 more``."""
    left_out = len(names) - most
    return ", ".join(names[:most]) + (f" and {left_out} more" if left_out > 0 else "")


def column(head: str, text: str, *, width: int = WIDTH) -> str:
    """Return ``head`` and ``text``, with ``text`` wrapped in a column to the right of ``head``.

    ``width`` is the length of a whole line. A word that is longer than the column stays whole,
    because users may copy it.
    """
    lines = wrap(text, max(20, width - len(head)), break_long_words=False, break_on_hyphens=False) or [""]
    return f"\n{' ' * len(head)}".join((head + lines[0], *lines[1:]))
