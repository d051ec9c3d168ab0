"""Prove that an expression stays within bounds on a region, without sympy.

There are three methods, cheapest first:

- interval arithmetic on the whole region;
- the exact sign of the expression minus a bound, also for quotients inside the expression;
- interval arithmetic on smaller and smaller parts of the region.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import inf

from tltlc.core.record import record, replace
from tltlc.expression.tree import Expression, Op
from tltlc.resolve.range_proof.cases import Constraints, size
from tltlc.resolve.range_proof.interval import EVERYTHING, Interval, UndefinedError, intersection
from tltlc.resolve.range_proof.region import ConstrainedBox, bound
from tltlc.resolve.range_proof.work_budget import spend

TOLERANCE = 1e-9  # the most that rounding may add to a value on a bound
MOST_PARTS = 300
_NODES_OF_ALL = 30_000  # the most nodes visited in all parts together
_FEWEST_PARTS = 10


@record
class ProofGoal:
    """What is to be proved: the value is defined and in ``[low, high]`` where all constraints hold."""

    value: Expression
    constraints: Constraints
    low: float
    high: float


def unproved_goals(goals: Sequence[ProofGoal], whole: ConstrainedBox) -> list[ProofGoal]:
    """Try to prove each goal on the region ``whole``, within a limited number of steps; return the unproved goals."""
    nodes = sum(size(goal.value, _NODES_OF_ALL) for goal in goals)
    parts = max(_FEWEST_PARTS, min(MOST_PARTS, _NODES_OF_ALL // max(1, nodes)))
    open_goals = []
    spend(nodes // 10)
    for goal in goals:
        region = whole.constrain(goal.constraints)
        if region is not None and not proves_within(goal.value, region, goal.low, goal.high, parts):
            open_goals.append(goal)
    return open_goals


def proves_within(value: Expression, region: ConstrainedBox, low: float, high: float, parts: int = MOST_PARTS) -> bool:
    """Whether ``value`` is provably defined and in ``[low, high]``, up to TOLERANCE, on the whole region.

    False means only that no proof was found. ``parts`` is the most parts into which the region is
    divided.
    """
    if holds_at_once(value, region, low, high):
        return True
    if _is_defined(value, region):
        region = _with_ratios(value, region)
        if holds_at_once(value, region, low, high) or _proves_by_sign(value, region, low, high):
            return True
    return _holds_in_parts(value, region, low, high, parts)


def holds_at_once(value: Expression, region: ConstrainedBox, low: float, high: float) -> bool:
    """Whether interval arithmetic on the undivided region proves that the value is in ``[low, high]``.

    The value must also be defined. It may be outside by TOLERANCE, because rounding may add as much.
    """
    try:
        return is_within(bound(value, region), low, high)
    except UndefinedError:
        return False


def proves_defined(value: Expression, region: ConstrainedBox, parts: int = MOST_PARTS) -> bool:
    """Whether the value is provably defined at each point of the region."""
    return _is_defined(value, region) or _holds_in_parts(value, region, -inf, inf, parts)


def is_within(bounds: Interval, low: float, high: float) -> bool:
    """Whether the interval lies in ``[low, high]``, up to TOLERANCE."""
    return bounds[0] >= low - TOLERANCE and bounds[1] <= high + TOLERANCE


def _is_defined(value: Expression, region: ConstrainedBox) -> bool:
    return holds_at_once(value, region, -inf, inf)


def _with_ratios(value: Expression, region: ConstrainedBox) -> ConstrainedBox:
    """Return the region with proved bounds on each quotient in ``value``, such as ``x / (x + 1) <= 1``.

    Only 0 and -1 are tried as lower bounds, and 0 and 1 as upper bounds. If no proof succeeds, the
    bound is infinite.
    """
    known = dict(region.known)
    for node in _ratios(value):
        low = next((end for end in (0.0, -1.0) if _proves_by_sign(node, region, end, inf)), -inf)
        high = next((end for end in (0.0, 1.0) if _proves_by_sign(node, region, -inf, end)), inf)
        known[node] = intersection(known.get(node, EVERYTHING), (low, high)) or (low, high)
        region = replace(region, known=known)
    return region


def _ratios(value: Expression) -> Iterator[Op]:
    if isinstance(value, Op):
        for arg in value.args:
            yield from _ratios(arg)
        if value.op == "/":
            yield value


def _proves_by_sign(value: Expression, region: ConstrainedBox, low: float, high: float) -> bool:
    """Whether exact signs prove that the value is in ``[low, high]``.

    The value is written as a quotient ``n / d``. If d has only one sign on the region, the signs of
    ``n - low * d`` and ``n - high * d`` decide.
    """
    from tltlc.resolve.range_proof.normal_form import TooLargeError, add, exact_decimal, polynomial_bound, quotient

    try:
        form = quotient(value)
        below = polynomial_bound(form.denominator, region)
        if below[0] < 0 < below[1]:
            return False
        sign = 1 if below[0] >= 0 else -1
        for end, side in ((low, sign), (high, -sign)):
            if end not in (-inf, inf):
                over = polynomial_bound(add(form.numerator, form.denominator, -exact_decimal(end)), region)
                if (over[0] < 0) if side > 0 else (over[1] > 0):
                    return False
    except (TooLargeError, UndefinedError):
        return False
    return True


def _holds_in_parts(value: Expression, region: ConstrainedBox, low: float, high: float, limit: int) -> bool:
    parts, tried = [region], 0
    while parts:
        part = parts.pop()
        tried += 1
        if holds_at_once(value, part, low, high):
            continue
        halves = part.halves()
        if halves is None or tried > limit:
            return False
        parts += [half for half in (whole.narrow() for whole in halves) if half is not None]
    return True
