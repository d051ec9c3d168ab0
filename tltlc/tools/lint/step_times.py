"""Write a number of steps of a fixed clock as a time, for clauses that a help names."""

from __future__ import annotations

from math import ceil, floor
from typing import Final

from tltlc.grammar.tree import NumberExpr
from tltlc.resolve import units

_COUNTED: Final = (None, "step", "steps")
_TOLERANCE_DIGITS: Final = 6


def steps_before(time: NumberExpr, step_s: float | None, *, inclusive: bool = False) -> int | None:
    """Return the greatest number of steps that take less than a time, or at most this time if ``inclusive``.

    A time without a unit is a number of steps. Return None if the clock ``step_s``, in seconds, is not fixed, and if
    ``time`` is no time.
    """
    steps = time.value
    if time.unit not in _COUNTED:
        in_si = units.in_si(time.value, time.unit)
        if in_si is None or in_si[1] != units.TYPES["time"] or not step_s:
            return None
        steps = round(in_si[0] / step_s, _TOLERANCE_DIGITS)
    return floor(steps) if inclusive else ceil(steps) - 1


def time_text(steps: int, unit: str | None, step_s: float | None) -> str:
    """Return the shortest decimal number, with its unit, that a bound reads as this number of steps.

    A bound rounds a time up to whole steps. ``unit`` is that of a time of :func:`steps_before`.
    """
    in_si = units.in_si(1.0, unit) if unit not in _COUNTED else None
    if in_si is not None and step_s:
        step = step_s / in_si[0]
        for digits in range(10):
            number = floor(round(steps * step * 10**digits, _TOLERANCE_DIGITS)) / 10**digits
            if number > round((steps - 1) * step, 9):
                return f"{number:.{digits}f} {unit}"
    return f"{steps} step{'s' * (steps != 1)}"
