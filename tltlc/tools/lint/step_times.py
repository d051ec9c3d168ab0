"""Write a number of steps of a fixed clock as a time, for clauses that a help names."""

from __future__ import annotations

from math import ceil, floor
from typing import Final

from tltlc.grammar.tree import NumberExpr

_SECONDS: Final = {"ms": 0.001, "s": 1.0, "min": 60.0, "h": 3600.0}
_TOLERANCE_DIGITS: Final = 6


def steps_before(time: NumberExpr, step_s: float | None, *, inclusive: bool = False) -> int | None:
    """Return the greatest number of steps that take less than a time, or at most this time if ``inclusive``.

    A time without a unit is a number of steps. Return None if the clock ``step_s``, in seconds, is not fixed, and if
    ``time`` is no time.
    """
    if time.unit in (None, "step", "steps"):
        steps = time.value
    elif time.unit in _SECONDS and step_s:
        steps = round(time.value * _SECONDS[time.unit] / step_s, _TOLERANCE_DIGITS)
    else:
        return None
    return floor(steps) if inclusive else ceil(steps) - 1


def time_text(steps: int, unit: str | None, step_s: float | None) -> str:
    """Return the shortest decimal number, with its unit, that a bound reads as this number of steps.

    A bound rounds a time up to whole steps. ``unit`` is that of a time of :func:`steps_before`.
    """
    if unit not in _SECONDS or not step_s:
        return f"{steps} step{'s' * (steps != 1)}"
    step = step_s / _SECONDS[unit]
    for digits in range(10):
        number = floor(round(steps * step * 10**digits, _TOLERANCE_DIGITS)) / 10**digits
        if number > round((steps - 1) * step, 9):
            return f"{number:.{digits}f} {unit}"
    return f"{steps} step{'s' * (steps != 1)}"
