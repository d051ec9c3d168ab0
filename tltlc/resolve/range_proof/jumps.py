"""Search for points on the border of two ``when`` cases where the value of an expression jumps.

The search is deterministic, and its work is bounded.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from tltlc.core.record import record
from tltlc.expression.tree import Expression, SignalValue
from tltlc.resolve.range_proof.cases import ConstrainedValue
from tltlc.resolve.range_proof.interval import midpoint
from tltlc.resolve.range_proof.region import Box, Variable
from tltlc.resolve.range_proof.witness import CLEARLY, Point, points, value_at

_MOST_POINTS = 150
_MOST_CROSSINGS = 60
_BORDER_WIDTH = 1e-14  # relative distance between the two points on either side of a border
_NEAR = 1e-7  # relative distance within which the value must stay about the same as at the border


@record
class Jump:
    """A point where the value is ``before`` on one side of a border and ``after`` on the other."""

    point: Point
    before: float
    after: float


def find_jump(
    all_cases: Sequence[ConstrainedValue],
    expression: Expression,
    box: Box,
    bools: frozenset[Variable],
    stepped: frozenset[Variable],
) -> Jump | None:
    """Search for a point on the border of two cases where the expression clearly jumps.

    ``all_cases`` are the cases of one ``when`` in the expression. Returns None if the search finds no
    such point, which does not prove that there is none. The values of variables in ``stepped`` change in
    steps: jumps along these are not searched for.
    """
    crossings = 0
    candidates = list(points(expression, box, bools))
    for start in candidates[:: 1 + len(candidates) // _MOST_POINTS]:
        here = _case_at(all_cases, start)
        if here is None:
            continue
        for variable in box:
            if variable in stepped or not isinstance(variable, SignalValue):
                continue
            for end in _points_along(start, variable, box, expression):
                there = _case_at(all_cases, end)
                if there is None or there.value == here.value:
                    continue
                crossings += 1
                if crossings > _MOST_CROSSINGS:
                    return None
                jump = _jump_between(all_cases, expression, start, end, variable)
                if jump is not None:
                    return jump
                break  # a second crossing on the same line adds little
    return None


def _case_at(all_cases: Sequence[ConstrainedValue], point: Point) -> ConstrainedValue | None:
    """Return the first case whose constraints all hold at a point, or None."""
    for case in all_cases:
        for constraint in case.constraints:
            value = value_at(constraint.difference, point).value
            if value is None or value < 0 or (constraint.strict and value == 0):
                break
        else:
            return case
    return None


def _points_along(start: Point, variable: Variable, box: Box, expression: Expression) -> Iterator[Point]:
    """Yield points that differ from ``start`` only in ``variable``.

    The values of ``variable`` are those that :func:`points` tries, a dozen at most.
    """
    seen = {start[variable]}
    for candidate in points(expression, {variable: box[variable]}, frozenset()):
        if candidate[variable] not in seen:
            seen.add(candidate[variable])
            yield {**start, variable: candidate[variable]}
        if len(seen) > 12:
            return


def _jump_between(
    all_cases: Sequence[ConstrainedValue], expression: Expression, start: Point, end: Point, variable: Variable
) -> Jump | None:
    """Find the border between two points by bisection, and return the jump there.

    ``start`` and ``end`` lie in different cases and differ only in ``variable``. Returns None if the
    value does not clearly jump at the border.
    """
    low, high = start[variable], end[variable]
    left, right = _case_at(all_cases, start), _case_at(all_cases, end)
    while abs(high - low) > _BORDER_WIDTH * max(1.0, abs(low)):
        middle = midpoint(low, high)
        case = _case_at(all_cases, {**start, variable: middle})
        if left is not None and case is not None and case.value == left.value:
            low = middle
        else:
            high, right = middle, case
    if left is None or right is None:
        return None
    step = _NEAR * max(1.0, abs(low)) * (1.0 if high > low else -1.0)
    before, after = (value_at(expression, {**start, variable: x}).value for x in (low, high))
    if before is None or after is None or abs(after - before) <= CLEARLY:
        return None
    for case, x, value in ((left, low - step, before), (right, high + step, after)):
        nearby = {**start, variable: x}
        near = value_at(expression, nearby).value
        if _case_at(all_cases, nearby) != case or near is None or abs(near - value) > abs(after - before) / 10:
            return None
    border = low if abs(low - round(low, 9)) <= abs(high - round(high, 9)) else high
    return Jump({**start, variable: border}, before, after)
