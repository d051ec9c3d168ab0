"""Numbers and lines for people."""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil, floor
from textwrap import wrap
from typing import Final

WIDTH: Final = 80
"""Of a terminal for which lines are broken, in characters."""

_FEW: Final = 25
"""Of so many things at most it is said how many, and no share."""


def share(value: float, places: int = 2) -> str:
    """A number in [0, 1] with so many places; 0 and 1 are written for nothing but themselves."""
    text, least = f"{value:.{places}f}", 10.0**-places
    if value < 1.0 <= float(text):
        return f"{1.0 - least:.{places}f}"
    return f"{least:.{places}f}" if float(text) == 0.0 < value else number(value, places)


def percent(value: float) -> str:
    """A number in [0, 1] in percent; 0% and 100% are written for nothing but themselves."""
    return f"{100.0 * float(share(value)):.0f}%"


def percent_exactly(value: float) -> str:
    """A number in [0, 1] that somebody chose, in percent with the places that it has: ``85%``, ``99.9%``."""
    return f"{100.0 * value:g}%"


def counted(count: int, total: int, what: str = "") -> str:
    """How many of a number of things, with the share where it takes working out: ``121 of 300 episodes (40%)``."""
    told = f"{count} of {total}{' ' * bool(what)}{what}"
    return f"{told} ({percent(count / total)})" if total > _FEW and 0 < count < total else told


def between(interval: tuple[float, float]) -> str:
    """An interval of shares in percent, rounded outwards: what is certain of the one is certain of the other."""
    low, high = floor(100.0 * interval[0] + 1e-9), ceil(100.0 * interval[1] - 1e-9)
    return f"{low}% to {high}%"


def number(value: float, places: int) -> str:
    """A number with so many places, none of them ``-0``."""
    text = f"{value:.{places}f}"
    return text.lstrip("-") if float(text) == 0.0 else text


def duration(seconds: float) -> str:
    """A span of time for people: ``45 s``, ``12 min 5 s``, ``3 h 20 min``."""
    minutes, rest = divmod(round(seconds), 60)
    if not minutes:
        return f"{rest} s"
    hours, minutes = divmod(minutes, 60)
    return f"{hours} h {minutes} min" if hours else f"{minutes} min {rest} s"


def listed(names: Sequence[str], most: int) -> str:
    """The first ``most`` of some names, with commas between them, and how many more there are."""
    more = len(names) - most
    return ", ".join(names[:most]) + (f" and {more} more" if more > 0 else "")


def column(head: str, text: str, *, width: int = WIDTH) -> str:
    """``text`` behind ``head``, broken at words where a line is full, the others below its beginning.

    A word that is longer than the room for it stays whole, since it may be copied.
    """
    lines = wrap(text, max(20, width - len(head)), break_long_words=False, break_on_hyphens=False) or [""]
    return f"\n{' ' * len(head)}".join((head + lines[0], *lines[1:]))
