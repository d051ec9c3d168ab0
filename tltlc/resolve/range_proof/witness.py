"""Search for points where the value of an expression leaves its declared range.

The search is deterministic, and its work is bounded.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import lru_cache
from itertools import islice, permutations, product
from math import inf, isfinite, prod

from tltlc.core.record import record
from tltlc.expression.evaluate import evaluate
from tltlc.expression.tree import LEAST, Const, Expression, ParamValue, SignalValue, nodes
from tltlc.resolve.range_proof.interval import Interval, midpoint
from tltlc.resolve.range_proof.region import Box, Variable
from tltlc.resolve.range_proof.work_budget import OutOfWorkError, spend

Point = Mapping[Variable, float]

CLEARLY = 1e-6  # how far outside its range a value must be to count as outside
_LARGEST_GRID = 500
_SCATTERED = 300
_CLIMBING_ROUNDS = 40
_SPREAD = (1.0, 3.0, 10.0, 100.0, 1e6)  # distances from the finite end of an unbounded range


@record
class SamplePoint:
    """A point with its value, or with the reason why there is no value."""

    point: Point
    value: float | None
    reason: str = ""
    is_undefined: bool = False
    """Whether the expression divides by zero there, or takes a root or power that no real number has."""


def value_at(expression: Expression, point: Point) -> SamplePoint:
    """Return the value of an expression at a point, or the reason why there is none."""
    spend(_cost(expression) + len(point) // 4)
    signals = {variable.name: value for variable, value in point.items() if isinstance(variable, SignalValue)}
    params = {variable.name: value for variable, value in point.items() if isinstance(variable, ParamValue)}
    try:
        value = evaluate(expression, signals, params)
    except ZeroDivisionError:
        return SamplePoint(point, None, "divides by zero", is_undefined=True)
    except OverflowError:
        return SamplePoint(point, None, "is too large to compute")
    except ValueError:
        return SamplePoint(point, None, "takes a root or power that no real number has", is_undefined=True)
    return SamplePoint(point, value) if isfinite(value) else SamplePoint(point, None, "is too large to compute")


@lru_cache(maxsize=512)
def _cost(expression: Expression) -> int:
    """Return how many steps one evaluation of an expression counts as."""
    return 1 + sum(1 for _ in nodes(expression)) // 3


def find_wrong_point(
    expression: Expression, box: Box, bools: frozenset[Variable], low: float, high: float
) -> SamplePoint | None:
    """Search a box for a point where the value is undefined or clearly outside ``[low, high]``.

    Returns None if there is no such point among those tried. Simple points are tried first. A later
    point replaces an earlier one only if it is much worse: undefined, or much farther outside.
    ``bools`` are the variables that are only 0 or 1. Raises OutOfWorkError if the step limit ends
    the search before it finds a point.
    """

    def excess(witness: SamplePoint) -> float:
        return inf if witness.value is None else max(low - witness.value, witness.value - high)

    best: SamplePoint | None = None
    try:
        for point in points(expression, box, bools):
            here = value_at(expression, point)
            if best is None or excess(here) > max(excess(best), 1.5 * excess(best)):
                best = here
            if best.value is None:
                return best
        if best is not None and excess(best) <= CLEARLY:
            best = _climb(best, excess, expression, box, bools)
    except OutOfWorkError:
        if best is None or excess(best) <= CLEARLY:
            raise
    return best if best is not None and excess(best) > CLEARLY else None


def points(expression: Expression, box: Box, bools: frozenset[Variable]) -> Iterator[Point]:
    """Yield the points to try, in a fixed order.

    First come the points of a grid with the corners of the box, then points where two variables are
    equal, then scattered points.
    """
    names = list(box)
    extra = tuple(dict.fromkeys(_constants(expression)))
    spend(_cost(expression) + len(names) * (len(extra) + 20) // 10)
    axes = [_axis(box[name], name in bools, extra) for name in names]
    grid = [dict(zip(names, values, strict=True)) for values in _grid(axes)]
    yield from grid
    for variable, partner in islice(permutations(names, 2), 20):
        for point in grid[:20]:
            if box[variable][0] <= point[partner] <= box[variable][1] and variable not in bools:
                yield {**point, variable: point[partner]}
    for number in range(1, _SCATTERED + 1 if names else 1):
        yield {
            name: _value_at_fraction(box[name], _fraction(number, position), name in bools)
            for position, name in enumerate(names)
        }


def _grid(axes: list[tuple[float, ...]]) -> Iterator[tuple[float, ...]]:
    """Yield the points of a grid, at most _LARGEST_GRID.

    The grid has all combinations of the first n values of each axis. The number n is the largest from 2
    to 12 that gives few enough points. If even n = 2 gives too many, only the first are yielded.
    """
    depth = 2
    while depth < 12 and prod(min(len(axis), depth + 1) for axis in axes) <= _LARGEST_GRID:
        depth += 1
    return islice(product(*(axis[:depth] for axis in axes)), _LARGEST_GRID)


def _axis(side: Interval, is_bool: bool, extra: tuple[float, ...]) -> tuple[float, ...]:
    """Return values worth trying for one variable, the simplest first."""
    low, high = side
    if is_bool:
        return low, high
    ends = [end for end in side if isfinite(end)]
    inner = [midpoint(low, high)] if len(ends) == 2 else [0.0]
    spread = [low + step for step in _SPREAD] + [high - step for step in _SPREAD]
    candidates = [*ends, *inner, *extra, 0.0, 1.0, -1.0, *(_SPREAD if not ends else spread)]
    if not ends:
        candidates += [-step for step in _SPREAD]
    return tuple(dict.fromkeys(x + 0.0 for x in candidates if isfinite(x) and low <= x <= high))


def _constants(expression: Expression) -> Iterator[float]:
    """Yield the constants in an expression as values to try for its variables, since cases may meet there.

    The constant LEAST is left out: it comes from scaling comparisons, and no case begins or ends there.
    """
    return (node.value for node in nodes(expression) if isinstance(node, Const) and node.value != LEAST)


def _fraction(number: int, position: int) -> float:
    """Return a number in [0, 1): term ``number`` of a sequence that is spread evenly.

    The sequence is an additive recurrence modulo 1. Its step depends on ``position``, the index of the
    variable, so that each variable has another sequence.
    """
    stride: float = 0.6180339887498949 ** (1 + position / 3)
    return (0.5 + number * stride) % 1.0


def _value_at_fraction(side: Interval, fraction: float, is_bool: bool) -> float:
    """Return the value at a fraction of a range: 2.5 for 0.25 of [0, 10].

    ``fraction`` is in [0, 1). An unbounded range is mapped so that most values lie near its finite end
    or near 0.
    """
    low, high = side
    if is_bool:
        return low if fraction < 0.5 else high
    if isfinite(low) and isfinite(high):
        at = low + fraction * (high - low) if isfinite(high - low) else low * (1 - fraction) + high * fraction
        return min(max(at, low), high)
    if isfinite(low) and high == inf:
        return low + fraction / (1.0 - fraction)
    if isfinite(high) and low == -inf:
        return high - fraction / (1.0 - fraction)
    centred = 2.0 * fraction - 1.0
    return min(max(2.0 * centred / (1.0 - abs(centred) + 1e-9), low), high)


def _climb(
    start: SamplePoint,
    excess: Callable[[SamplePoint], float],
    expression: Expression,
    box: Box,
    bools: frozenset[Variable],
) -> SamplePoint:
    """Search for a local maximum of ``excess`` from ``start``, and return its point.

    The excess of a point says how far the value there lies outside the allowed range. The search
    takes smaller and smaller steps along the axes.
    """
    best = start
    steps = {v: (high - low) / 8 if isfinite(high - low) else 1.0 for v, (low, high) in box.items() if v not in bools}
    for _ in range(_CLIMBING_ROUNDS):
        for variable, step in steps.items():
            low, high = box[variable]
            old = best.point[variable]
            improved = False
            for value in (min(old + step, high), max(old - step, low)):
                here = value_at(expression, {**best.point, variable: value})
                if excess(here) > excess(best):
                    best, improved = here, True
            steps[variable] = step * (1.0 if improved else 0.5)
        if best.value is None:
            break
    return best
