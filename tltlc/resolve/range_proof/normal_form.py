"""Convert expressions to quotients of polynomials, to compare them and find their signs exactly.

A polynomial maps monomials to coefficients. A monomial is a set of (factor, exponent) pairs. A
factor is a signal, a param, or an expression such as ``sqrt(x)``, whose operator is not one of
``+ - * / ^``.
"""

from __future__ import annotations

from fractions import Fraction

from tltlc.core.record import record
from tltlc.expression.tree import Const, Expression, Op, ParamValue, SignalValue
from tltlc.resolve.range_proof import interval
from tltlc.resolve.range_proof.interval import Interval
from tltlc.resolve.range_proof.region import ConstrainedBox, bound
from tltlc.resolve.range_proof.work_budget import current_budget, spend

Monomial = frozenset[tuple[Expression, int]]
Polynomial = dict[Monomial, Fraction]

ONE: Monomial = frozenset()
_MOST_TERMS = 200
_LARGEST_EXPONENT = 12
MOST_BITS = 10_000
"""The most bits of a coefficient: enough for any float to the power of four."""


class TooLargeError(Exception):
    """Raised when the normal form of an expression would be too large."""


@record
class Quotient:
    """A quotient of polynomials, which equals an expression wherever the expression is defined."""

    numerator: Polynomial
    denominator: Polynomial


def quotient(expression: Expression) -> Quotient:
    """Return the normal form of an expression without ``when``: a quotient of polynomials.

    The result is cached until the active
    :func:`~tltlc.resolve.range_proof.work_budget.step_limit` ends. Raises TooLargeError.
    """
    work = current_budget()
    if work is None or not isinstance(expression, Op):
        return _quotient(expression)
    spend()
    if expression not in work.memo:
        try:
            work.memo[expression] = _quotient(expression)
        except TooLargeError as error:
            work.memo[expression] = error
    form = work.memo[expression]
    if isinstance(form, TooLargeError):
        raise TooLargeError
    assert isinstance(form, Quotient)
    return form


def _quotient(expression: Expression) -> Quotient:
    if isinstance(expression, Const):
        return Quotient(constant(exact_decimal(expression.value)), constant(1))
    if isinstance(expression, Op):
        if expression.op in ("+", "-", "*", "/", "neg"):
            return _arithmetic(expression.op, [quotient(arg) for arg in expression.args])
        exponent = expression.args[-1]
        if expression.op == "^" and isinstance(exponent, Const) and exponent.value == int(exponent.value):
            return _power(quotient(expression.args[0]), int(exponent.value))
    assert isinstance(expression, (SignalValue, ParamValue, Op)), "cases have no `when`"
    return Quotient({frozenset([(expression, 1)]): Fraction(1)}, constant(1))


def exact_decimal(value: float) -> Fraction:
    """Return the decimal number that a float prints as, exactly: 1/10 for 0.1."""
    return Fraction(repr(float(value)))


def constant(value: Fraction | int) -> Polynomial:
    """Return a number as a polynomial."""
    return {ONE: Fraction(value)} if value else {}


def polynomial_bound(polynomial: Polynomial, region: ConstrainedBox) -> Interval:
    """Return an interval that contains all values of a polynomial on a region.

    Raises UndefinedError if a factor may be undefined on the region, and TooLargeError if a
    coefficient does not fit into a float.
    """
    total = _sum_of_terms(polynomial, region)
    for expression, known in region.known.items():
        spend(1 + len(polynomial) // 4)
        try:
            form = quotient(expression)
        except TooLargeError:
            continue
        scale = _ratio(polynomial, form.numerator) if form.denominator == constant(1) else None
        if scale is not None:  # polynomial = scale * expression + rest
            rest = polynomial.get(ONE, Fraction(0)) - scale * form.numerator.get(ONE, Fraction(0))
            bounds = interval.add(interval.multiply(known, _point(scale)), _point(rest))
            total = interval.intersection(total, bounds) or bounds
    return total


def add(a: Polynomial, b: Polynomial, scale: Fraction | int = 1) -> Polynomial:
    """Return ``a + scale * b``."""
    spend(len(b))
    result = dict(a)
    for monomial, coefficient in b.items():
        total = result.get(monomial, Fraction(0)) + scale * coefficient
        if total:
            result[monomial] = total
        else:
            result.pop(monomial, None)
    return result


def multiply(a: Polynomial, b: Polynomial) -> Polynomial:
    """Return ``a * b``. Raises TooLargeError."""
    if len(a) * len(b) > _MOST_TERMS * 10:
        raise TooLargeError
    spend(2 * len(a) * len(b))
    result: Polynomial = {}
    for left, x in a.items():
        for right, y in b.items():
            monomial = _join(left, right)
            result[monomial] = result.get(monomial, Fraction(0)) + x * y
    result = {monomial: coefficient for monomial, coefficient in result.items() if coefficient}
    if len(result) > _MOST_TERMS or any(_bits(coefficient) > MOST_BITS for coefficient in result.values()):
        raise TooLargeError
    return result


def substitute(polynomial: Polynomial, factor: Expression, by: Polynomial) -> Polynomial:
    """Return the polynomial with ``factor`` replaced by the polynomial ``by``. Raises TooLargeError."""
    result: Polynomial = {}
    spend(len(polynomial))
    for monomial, coefficient in polynomial.items():
        exponent = next((n for base, n in monomial if base == factor), 0)
        rest = frozenset(pair for pair in monomial if pair[0] != factor)
        term: Polynomial = {rest: coefficient}
        for _ in range(exponent):
            term = multiply(term, by)
        result = add(result, term)
    return result


def solve_for_factor(equation: Polynomial) -> tuple[Expression, Polynomial] | None:
    """Solve ``equation = 0`` for a factor that occurs once, with a constant coefficient.

    Returns the factor and its value, or None if there is no such factor.
    """
    occurrences: dict[Expression, int] = {}
    for monomial in equation:
        for factor, _ in monomial:
            occurrences[factor] = occurrences.get(factor, 0) + 1
    for monomial, coefficient in equation.items():
        if len(monomial) == 1:
            ((factor, exponent),) = monomial
            if exponent == 1 and occurrences[factor] == 1:
                rest = {m: c for m, c in equation.items() if m != monomial}
                return factor, add({}, rest, -1 / coefficient)
    return None


def _arithmetic(op: str, args: list[Quotient]) -> Quotient:
    result = args[0]
    if op == "neg":
        return Quotient(add({}, result.numerator, -1), result.denominator)
    for operand in args[1:]:
        if op == "*":
            result = _reduced_product(result.numerator, result.denominator, operand.numerator, operand.denominator)
        elif op == "/":
            result = _reduced_product(result.numerator, result.denominator, operand.denominator, operand.numerator)
        elif result.denominator == operand.denominator:
            sign = 1 if op == "+" else -1
            result = Quotient(add(result.numerator, operand.numerator, sign), result.denominator)
        else:
            left = multiply(result.numerator, operand.denominator)
            right = multiply(operand.numerator, result.denominator)
            sign = 1 if op == "+" else -1
            result = Quotient(add(left, right, sign), multiply(result.denominator, operand.denominator))
    return result


def _reduced_product(a: Polynomial, b: Polynomial, c: Polynomial, d: Polynomial) -> Quotient:
    """Return ``a/b * c/d``; cancel a numerator if it is a multiple of the other denominator."""
    scale = _multiple(a, d)
    if scale is not None:
        return Quotient(add({}, c, scale), b)
    scale = _multiple(c, b)
    if scale is not None:
        return Quotient(add({}, a, scale), d)
    return Quotient(multiply(a, c), multiply(b, d))


def _power(base: Quotient, exponent: int) -> Quotient:
    if abs(exponent) > _LARGEST_EXPONENT:
        raise TooLargeError
    above, below = constant(1), constant(1)
    for _ in range(abs(exponent)):
        above, below = multiply(above, base.numerator), multiply(below, base.denominator)
    return Quotient(above, below) if exponent >= 0 else Quotient(below, above)


def _bits(number: Fraction) -> int:
    return number.numerator.bit_length() + number.denominator.bit_length()


def _join(a: Monomial, b: Monomial) -> Monomial:
    exponents = dict(a)
    for factor, exponent in b:
        exponents[factor] = exponents.get(factor, 0) + exponent
    return frozenset(exponents.items())


def _multiple(a: Polynomial, b: Polynomial) -> Fraction | None:
    """Return the number ``c`` with ``a = c * b``, or None if there is no such number."""
    if not b or a.keys() != b.keys():
        return None
    first = next(iter(b))
    scale = a[first] / b[first]
    return scale if all(a[monomial] == scale * b[monomial] for monomial in b) else None


def _ratio(a: Polynomial, b: Polynomial) -> Fraction | None:
    """Return the number ``c`` with ``a = c * b`` except for the constant terms, or None if there is no such number."""
    return _multiple({m: c for m, c in a.items() if m}, {m: c for m, c in b.items() if m})


def _sum_of_terms(polynomial: Polynomial, region: ConstrainedBox) -> Interval:
    total: Interval = (0.0, 0.0)
    spend(len(polynomial))
    for monomial, coefficient in polynomial.items():
        term = _point(coefficient)
        for factor, exponent in monomial:
            value = interval.power(bound(factor, region), (float(exponent),) * 2)
            term = interval.multiply(term, value)
        total = interval.add(total, term)
    return total


def _point(value: Fraction) -> Interval:
    try:
        number = float(value)
    except OverflowError as error:
        raise TooLargeError from error
    if (number == 0) != (value == 0):
        raise TooLargeError
    return number, number
