"""Interval arithmetic on the real line, rounded outwards.

An interval is a pair ``(low, high)`` with ``low <= high``. An infinite end means that there is no
bound on that side; the values themselves are finite. A function such as :func:`add` takes and returns
intervals. Its result contains the sum of any two numbers from the argument intervals. An end that is
exactly 0 is not rounded, so signs survive.
"""

from __future__ import annotations

from math import exp, inf, isfinite, isinf, nextafter, sqrt, tanh

Interval = tuple[float, float]

EVERYTHING: Interval = (-inf, inf)
LARGEST_EXPONENT = 709.0  # exp overflows a little above
_LARGEST_POWER = 64


class UndefinedError(Exception):
    """Raised when an operation may be undefined for numbers from its argument intervals; the text says why."""


def add(a: Interval, b: Interval) -> Interval:
    """Return an interval that contains ``x + y`` for all x in a and y in b."""
    return _sum(a[0], b[0], -inf), _sum(a[1], b[1], inf)


def negate(a: Interval) -> Interval:
    """Return the interval of ``-x`` for all x in a."""
    return -a[1], -a[0]


def subtract(a: Interval, b: Interval) -> Interval:
    """Return an interval that contains ``x - y`` for all x in a and y in b."""
    return add(a, negate(b))


def multiply(a: Interval, b: Interval) -> Interval:
    """Return an interval that contains ``x * y`` for all x in a and y in b."""
    corners = [(x, y) for x in a for y in b]
    return min(_product(x, y, -inf) for x, y in corners), max(_product(x, y, inf) for x, y in corners)


def divide(a: Interval, b: Interval, *, nonzero: bool = False) -> Interval:
    """Return an interval that contains ``x / y`` for all x in a and y in b.

    Raises UndefinedError if b contains 0. With ``nonzero``, an end of b may be 0, and y is any other
    number of b.
    """
    if b[0] < 0 < b[1] or b == (0.0, 0.0) or (0.0 in b and not nonzero):
        raise UndefinedError("divides by zero")
    corners = [(x, y) for x in a for y in _signed_ends(b)]
    return min(_quotient(x, y, -inf) for x, y in corners), max(_quotient(x, y, inf) for x, y in corners)


def power(a: Interval, b: Interval) -> Interval:
    """Return an interval that contains ``x ^ y`` for all x in a and y in b.

    Raises UndefinedError if some ``x ^ y`` is the root of a negative number, or 0 to a negative power.
    """
    if b[0] == b[1] and b[0] == int(b[0]) and abs(b[0]) <= _LARGEST_POWER:
        return _integer_power(a, int(b[0]))
    if a[0] < 0:
        raise UndefinedError("takes the root of a negative number")
    if a[0] == 0 and b[0] <= 0:
        raise UndefinedError("raises zero to a negative power")
    corners = [_real_power(x, y) for x in a for y in b]
    return max(0.0, _round_outwards(min(corners), -inf)), _round_outwards(max(corners), inf)


def root(a: Interval) -> Interval:
    """Return an interval that contains the square root of each x in a.

    Raises UndefinedError if a contains a negative number.
    """
    if a[0] < 0:
        raise UndefinedError("takes the root of a negative number")
    return _root(a[0], -inf), _root(a[1], inf)


def exponential(a: Interval) -> Interval:
    """Return an interval that contains ``exp(x)`` for each x in a.

    Raises UndefinedError if ``exp(x)`` may overflow.
    """
    if a[1] > LARGEST_EXPONENT:
        raise UndefinedError("is too large to compute")
    low, high = (
        1.0 if end == 0 else _round_outwards(exp(end), towards) for end, towards in zip(a, (-inf, inf), strict=True)
    )
    return max(0.0, low), high


def hyperbolic_tangent(a: Interval) -> Interval:
    """Return an interval that contains ``tanh(x)`` for each x in a."""
    low, high = (
        0.0 if end == 0 else _round_outwards(tanh(end), towards) for end, towards in zip(a, (-inf, inf), strict=True)
    )
    return max(-1.0, low), min(1.0, high)


def absolute(a: Interval) -> Interval:
    """Return the interval of ``abs(x)`` for all x in a."""
    if a[0] >= 0:
        return a
    return (-a[1], -a[0]) if a[1] <= 0 else (0.0, max(-a[0], a[1]))


def minimum(a: Interval, b: Interval) -> Interval:
    """Return the interval of ``min(x, y)`` for all x in a and y in b."""
    return min(a[0], b[0]), min(a[1], b[1])


def maximum(a: Interval, b: Interval) -> Interval:
    """Return the interval of ``max(x, y)`` for all x in a and y in b."""
    return max(a[0], b[0]), max(a[1], b[1])


def intersection(a: Interval, b: Interval) -> Interval | None:
    """Return the intersection of two intervals, or None if it is empty."""
    low, high = max(a[0], b[0]), min(a[1], b[1])
    return (low, high) if low <= high else None


def midpoint(low: float, high: float) -> float:
    """Return the middle of two finite numbers, even if their difference overflows."""
    return low + (high - low) / 2 if isfinite(high - low) else low / 2 + high / 2


def _integer_power(a: Interval, n: int) -> Interval:
    if n == 0:
        return 1.0, 1.0
    if n < 0:
        return divide((1.0, 1.0), _integer_power(a, -n))
    low, high = absolute(a) if n % 2 == 0 else a
    return _outward_power(low, n, -inf), _outward_power(high, n, inf)


def _outward_power(x: float, n: int, towards: float) -> float:
    if n == 1 or x in (0.0, 1.0, -1.0):
        return x**n
    negative = x < 0 and n % 2 == 1
    return _round_outwards(_real_power(abs(x), float(n)) * (-1.0 if negative else 1.0), towards, negative)


def _real_power(x: float, y: float) -> float:
    if x == 1.0:
        return 1.0
    try:
        return float(x**y)
    except OverflowError:
        return inf
    except ZeroDivisionError:
        return inf


def _root(x: float, towards: float) -> float:
    value = sqrt(x)
    return value if value * value == x and value == int(min(value, 1e6)) else max(0.0, _round_outwards(value, towards))


def _sum(x: float, y: float, towards: float) -> float:
    total = x + y
    if total - x == y and total - y == x:
        return total
    return _round_outwards(total, towards)


def _product(x: float, y: float, towards: float) -> float:
    if x == 0 or y == 0:
        return 0.0
    if abs(x) == 1 or abs(y) == 1:
        return x * y
    return _round_outwards(x * y, towards, (x < 0) != (y < 0))


def _quotient(x: float, y: float, towards: float) -> float:
    if x == 0 or isinf(y):
        return 0.0  # if both are infinite, the other corners give the infinite end
    if abs(y) == 1:
        return x * y
    if x == y:
        return 1.0
    negative = (x < 0) != (y < 0)
    if abs(y) < 1e-300:
        return -inf if negative else inf
    return _round_outwards(x / y, towards, negative)


def _signed_ends(b: Interval) -> Interval:
    """Return the ends of ``b``, with an end at 0 replaced by the number next to 0 inside ``b``.

    0 may be an end of ``b``, but must not lie between its ends.
    """
    return (b[0] or 5e-324), (b[1] or -5e-324)


def _round_outwards(x: float, towards: float, negative: bool | None = None) -> float:
    """Return the second float after ``x`` towards ``towards``.

    One float would not be enough, since library functions may err by one. ``negative`` says whether
    the exact value is negative, if this is known. The result is then 0 in place of a float of the
    wrong sign.
    """
    value = nextafter(nextafter(x, towards), towards)
    if negative is not None and (value > 0) == negative:
        return 0.0
    return value
