"""Is a value continuous in its signals where one ``when`` case meets another?

For fixed params, two cases meet at most where all their constraints hold with ``>`` read as ``>=``.
If both values agree there, for every pair of cases, the whole is continuous.  Bool signals only take
two values and are treated like params.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations, islice

from tltlc.expression import Expression, Op, Signal
from tltlc.resolve.predicate_check.cases import Case, Constraint, variables
from tltlc.resolve.predicate_check.interval import UndefinedError
from tltlc.resolve.predicate_check.proof import holds_at_once, proves_defined, proves_within
from tltlc.resolve.predicate_check.region import Box, Region, Variable
from tltlc.resolve.predicate_check.witness import CLEARLY, Point, points, value_at

_MOST_POINTS = 150
_MOST_CROSSINGS = 60
_BORDER_WIDTH = 1e-14  # relative distance of the two points that stand for the sides of a border
_NEAR = 1e-7  # relative distance at which the value must still be about the same as at the border


@dataclass(frozen=True, slots=True)
class Meeting:
    """Two cases and the region that contains every point where they meet."""

    first: Case
    second: Case
    constraints: tuple[Constraint, ...]
    region: Region


@dataclass(frozen=True, slots=True)
class Jump:
    """At ``point`` the value is ``before`` on one side of a border and ``after`` on the other."""

    point: Point
    before: float
    after: float


def meetings(all_cases: Sequence[Case], whole: Region, bools: frozenset[Variable]) -> Iterator[Meeting]:
    """The pairs of cases with different values that may meet."""
    for first, second in combinations(all_cases, 2):
        if first.value == second.value:
            continue
        constraints = tuple(_closed(c, bools) for c in dict.fromkeys((*first.constraints, *second.constraints)))
        region = whole.where(constraints)
        if region is not None:
            yield Meeting(first, second, constraints, region)


def proves_agreement(meeting: Meeting) -> bool:
    """True if both values are defined and equal wherever the two cases meet."""
    difference = Op("-", (meeting.first.value, meeting.second.value))
    if holds_at_once(difference, meeting.region, 0.0, 0.0):
        return True
    if not proves_defined(difference, meeting.region):
        return False
    return _same_after_substitution(difference, meeting.region) or proves_within(difference, meeting.region, 0.0, 0.0)


def find_jump(all_cases: Sequence[Case], expression: Expression, box: Box, bools: frozenset[Variable]) -> Jump | None:
    """A border point between two cases where the value clearly jumps, or None if no such point is found."""
    crossings = 0
    for start in islice(points(expression, box, bools), _MOST_POINTS):
        here = _active(all_cases, start)
        if here is None:
            continue
        for variable in box:
            if variable in bools or not isinstance(variable, Signal):
                continue
            for end in _along(start, variable, box, expression):
                there = _active(all_cases, end)
                if there is None or there.value == here.value:
                    continue
                crossings += 1
                if crossings > _MOST_CROSSINGS:
                    return None
                jump = _jump_between(all_cases, start, end, variable)
                if jump is not None:
                    return jump
    return None


def _closed(constraint: Constraint, bools: frozenset[Variable]) -> Constraint:
    """The constraint on the border: ``>=`` if a signal can come arbitrarily near to it."""
    if any(isinstance(v, Signal) and v not in bools for v in variables(constraint.difference)):
        return Constraint(constraint.difference, False)
    return constraint


def _same_after_substitution(difference: Expression, region: Region) -> bool:
    """True if the difference is zero once each equation that holds on the region is solved and put in."""
    from tltlc.resolve.predicate_check import normal_form as nf

    try:
        form = nf.quotient(difference)
        numerator, denominator = form.numerator, form.denominator
        equations = [nf.quotient(e).numerator for e, known in region.known.items() if known == (0.0, 0.0)]
        equations += [
            nf.add(nf.quotient(variable).numerator, nf.constant(nf.exact(side[0])), -1)
            for variable, side in region.box.items()
            if side[0] == side[1]
        ]
        while equations:
            solved = nf.solved(equations.pop())
            if solved is not None:
                factor, by = solved
                numerator, denominator, *equations = (
                    nf.substitute(polynomial, factor, by) for polynomial in (numerator, denominator, *equations)
                )
        return not numerator and bool(denominator)
    except (nf.TooLargeError, UndefinedError):
        return False


def _active(all_cases: Sequence[Case], point: Point) -> Case | None:
    for case in all_cases:
        for constraint in case.constraints:
            value = value_at(constraint.difference, point).value
            if value is None or value < 0 or (constraint.strict and value == 0):
                break
        else:
            return case
    return None


def _along(start: Point, variable: Variable, box: Box, expression: Expression) -> Iterator[Point]:
    """Other points on the line through ``start`` along one axis."""
    seen = {start[variable]}
    for other in points(expression, {variable: box[variable]}, frozenset()):
        if other[variable] not in seen:
            seen.add(other[variable])
            yield {**start, variable: other[variable]}
        if len(seen) > 12:
            return


def _jump_between(all_cases: Sequence[Case], start: Point, end: Point, variable: Variable) -> Jump | None:
    """Halve the way between points of different cases down to the border; is there a jump?"""
    low, high = start[variable], end[variable]
    left, right = _active(all_cases, start), _active(all_cases, end)
    while abs(high - low) > _BORDER_WIDTH * max(1.0, abs(low)):
        middle = low + (high - low) / 2
        case = _active(all_cases, {**start, variable: middle})
        if case is None:
            return None
        if left is not None and case.value == left.value:
            low = middle
        else:
            high, right = middle, case
    if left is None or right is None:
        return None
    before, after = (value_at(case.value, {**start, variable: x}).value for case, x in ((left, low), (right, high)))
    if before is None or after is None or abs(after - before) <= CLEARLY:
        return None
    step = _NEAR * max(1.0, abs(low)) * (1.0 if high > low else -1.0)
    for case, x, value in ((left, low - step, before), (right, high + step, after)):
        nearby = {**start, variable: x}
        near = value_at(case.value, nearby).value
        if _active(all_cases, nearby) != case or near is None or abs(near - value) > abs(after - before) / 10:
            return None
    border = low if abs(low - round(low, 9)) <= abs(high - round(high, 9)) else high
    return Jump({**start, variable: border}, before, after)
