"""Proves that an expression stays within bounds on a region, without sympy.

Three means, cheapest first: interval arithmetic on the whole region, the sign of the exact
difference to each bound, and interval arithmetic on ever smaller parts of the region.
"""

from __future__ import annotations

from math import inf

from tltlc.expression import Expression
from tltlc.resolve.predicate_check.interval import Interval, UndefinedError
from tltlc.resolve.predicate_check.region import Region, bound

TOLERANCE = 1e-9  # what rounding may add to a value that lies on a bound
_MOST_PARTS = 300


def proves_within(value: Expression, region: Region, low: float, high: float) -> bool:
    """True if the value is defined and in ``[low, high]``, up to TOLERANCE, at each point of the region."""
    if holds_at_once(value, region, low, high):
        return True
    if _defined(value, region) and _proves_by_sign(value, region, low, high):
        return True
    return _holds_in_parts(value, region, low, high)


def holds_at_once(value: Expression, region: Region, low: float, high: float) -> bool:
    """Like proves_within, by one evaluation with intervals."""
    try:
        return inside(bound(value, region), low, high)
    except UndefinedError:
        return False


def proves_defined(value: Expression, region: Region) -> bool:
    """True if the value exists at each point of the region."""
    return _defined(value, region) or _holds_in_parts(value, region, -inf, inf)


def inside(bounds: Interval, low: float, high: float) -> bool:
    """True if the interval lies in ``[low, high]``, up to TOLERANCE."""
    return bounds[0] >= low - TOLERANCE and bounds[1] <= high + TOLERANCE


def _defined(value: Expression, region: Region) -> bool:
    return holds_at_once(value, region, -inf, inf)


def _proves_by_sign(value: Expression, region: Region, low: float, high: float) -> bool:
    """For ``n/d`` with d of one sign: the signs of ``n - low * d`` and ``n - high * d`` tell."""
    from tltlc.resolve.predicate_check.normal_form import TooLargeError, add, exact, polynomial_bound, quotient

    try:
        form = quotient(value)
        below = polynomial_bound(form.denominator, region)
        if below[0] < 0 < below[1]:
            return False
        sign = 1 if below[0] >= 0 else -1
        over_low = polynomial_bound(add(form.numerator, form.denominator, -exact(low)), region)
        over_high = polynomial_bound(add(form.numerator, form.denominator, -exact(high)), region)
    except (TooLargeError, UndefinedError):
        return False
    return (over_low[0] >= 0 >= over_high[1]) if sign > 0 else (over_low[1] <= 0 <= over_high[0])


def _holds_in_parts(value: Expression, region: Region, low: float, high: float) -> bool:
    parts, tried = [region], 0
    while parts:
        part = parts.pop()
        tried += 1
        if holds_at_once(value, part, low, high):
            continue
        halves = part.halves()
        if halves is None or tried > _MOST_PARTS:
            return False
        parts += [half for half in (whole.narrowed() for whole in halves) if half is not None]
    return True
