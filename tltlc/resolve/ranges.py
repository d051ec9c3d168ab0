"""Compute the range of an operator's result from the ranges of its arguments.

This is plain interval arithmetic without outward rounding. It computes the values of constants and
the ranges by which comparisons are scaled, where a range from 0 to 1 must not grow by rounding.
Each operation rounds as the evaluator does, so rounding never puts the value of an expression
outside its range. Proofs about predicates use the rigorous arithmetic of
:mod:`tltlc.resolve.range_proof`.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import reduce
from math import exp, inf, isfinite, isnan, prod, sqrt, tanh

from tltlc.expression.evaluate import MULTIPLIED_EXPONENTS

ValueRange = tuple[float, float]
EVERYTHING: ValueRange = (-inf, inf)


def range_of(op: str, args: tuple[ValueRange, ...]) -> ValueRange:
    """Return the range of the results of the operator ``op`` (:class:`tltlc.expression.tree.Op`).

    Returns ``EVERYTHING`` if the result may be unbounded or undefined.
    """
    try:
        low, high = _FUNCTIONS[op](*args)
    except (OverflowError, ZeroDivisionError):
        return EVERYTHING
    return EVERYTHING if isnan(low) or isnan(high) else (low, high)


def overflows(op: str, args: tuple[ValueRange, ...]) -> bool:
    """Whether ``op`` may overflow for arguments in finite ranges.

    False if a range is infinite, or if the operator is undefined somewhere, as ``1 / x`` is at 0.
    """
    if not all(isfinite(end) for arg in args for end in arg) or not _is_defined(op, args):
        return False
    return not all(isfinite(end) for end in range_of(op, args))


def _is_defined(op: str, args: tuple[ValueRange, ...]) -> bool:
    first, second = args[0], args[-1]
    if op == "/":
        return not second[0] <= 0 <= second[1]
    if op == "sqrt":
        return first[0] >= 0
    if op != "^" or first[0] > 0:
        return True
    return second[0] == second[1] == int(second[0]) and (second[0] >= 0 or first[1] < 0)


def hull(ranges: tuple[ValueRange, ...]) -> ValueRange:
    """Return the smallest range that contains all the ranges."""
    return min(low for low, _ in ranges), max(high for _, high in ranges)


def _add(*args: ValueRange) -> ValueRange:
    return reduce(lambda a, b: (a[0] + b[0], a[1] + b[1]), args)


def _subtract(a: ValueRange, b: ValueRange) -> ValueRange:
    return a[0] - b[1], a[1] - b[0]


def _multiply(*args: ValueRange) -> ValueRange:
    return reduce(lambda a, b: _corners(a, b, lambda x, y: 0.0 if 0.0 in (x, y) else x * y), args)


def _divide(a: ValueRange, b: ValueRange) -> ValueRange:
    if b[0] <= 0 <= b[1]:
        return EVERYTHING
    return _corners(a, b, lambda x, y: 0.0 if abs(y) == inf else x / y)


def _power(a: ValueRange, b: ValueRange) -> ValueRange:
    exponent = b[0]
    if b[0] == b[1] and exponent == int(exponent):
        if exponent < 0 and a[0] <= 0 <= a[1]:
            return EVERYTHING
        ends = _abs(a) if exponent % 2 == 0 else a
        values = [_integer_power(end, exponent) for end in ends]
        return min(values), max(values)
    if a[0] < 0 or (a[0] == 0 and b[0] <= 0):
        return EVERYTHING
    return _corners(a, b, lambda x, y: float(x**y))


def _integer_power(x: float, exponent: float) -> float:
    """Return ``x ^ exponent``, rounded as :func:`tltlc.expression.evaluate.evaluate` rounds it."""
    factors = MULTIPLIED_EXPONENTS.get(exponent)
    return float(x**exponent) if factors is None else prod([x] * (factors - 1), start=x)


def _abs(a: ValueRange) -> ValueRange:
    if a[0] >= 0:
        return a
    return (-a[1], -a[0]) if a[1] <= 0 else (0.0, max(-a[0], a[1]))


def _clamp(a: ValueRange, low: ValueRange, high: ValueRange) -> ValueRange:
    return min(max(a[0], low[0]), high[0]), min(max(a[1], low[1]), high[1])


def _sqrt(a: ValueRange) -> ValueRange:
    return EVERYTHING if a[0] < 0 else (sqrt(a[0]), sqrt(a[1]))


def _corners(a: ValueRange, b: ValueRange, function: Callable[[float, float], float]) -> ValueRange:
    values = [function(x, y) for x in a for y in b]
    return min(values), max(values)


_FUNCTIONS: dict[str, Callable[..., ValueRange]] = {
    "+": _add,
    "-": _subtract,
    "*": _multiply,
    "/": _divide,
    "^": _power,
    "neg": lambda a: (-a[1], -a[0]),
    "min": lambda *args: (min(a[0] for a in args), min(a[1] for a in args)),
    "max": lambda *args: (max(a[0] for a in args), max(a[1] for a in args)),
    "abs": _abs,
    "clamp": _clamp,
    "sqrt": _sqrt,
    "exp": lambda a: (exp(a[0]), exp(a[1])),
    "tanh": lambda a: (tanh(a[0]), tanh(a[1])),
}
