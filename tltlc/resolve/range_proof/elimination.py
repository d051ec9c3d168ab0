"""Prove that a quotient of polynomials is never negative, by eliminating one variable after another.

On a closed region, for fixed other variables, the minimum of a continuous ``f`` over one variable
lies where the derivative is 0, at a root of a constraint, at an end of the variable's range, or in
the limit at an open end. Substituting each of these candidates gives functions of the other
variables, which must not be negative either. The number of steps and the size of the terms are
limited, so an answer always comes.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import comb, inf, isfinite
from typing import Any

import sympy

from tltlc.expression.tree import Const, Expression, Op, SignalValue
from tltlc.resolve.range_proof.cases import Constraint
from tltlc.resolve.range_proof.interval import Interval, UndefinedError
from tltlc.resolve.range_proof.proof import TOLERANCE, proves_within
from tltlc.resolve.range_proof.region import ConstrainedBox, bound
from tltlc.resolve.range_proof.work_budget import spend

LARGEST_DEGREE = 8

_MOST_STEPS = 120
_MOST_OPERATIONS = 150
_MOST_TERMS = 3000
_PARTS = 10
_SURELY_POSITIVE = 1e-12
_STEPS_OF_SYMPY = 300
"""The least number of steps that a sympy call counts as."""

Term = Any  # a sympy expression; sympy has no type annotations
Ranges = Mapping[Term, Interval]


class GiveUpError(Exception):
    """Raised when a proof needs a method that this module does not have, or too many steps."""


class Prover:
    """Proves that terms are never negative.

    The methods raise GiveUpError if a proof needs another method, or if the steps are used up.
    """

    def __init__(self) -> None:
        self.steps = 0

    def proves_nonnegative(self, f: Term, limits: Sequence[Term], ranges: Ranges, *, strict: bool) -> bool:
        """Whether f is provably >= 0 (> 0 if strict) wherever all ``limits`` are >= 0.

        ``limits`` are terms. ``ranges`` has the range of every symbol in f and in the limits. If the
        result is False, f may still be >= 0.
        """
        self.steps += 1
        if self.steps > _MOST_STEPS:
            raise GiveUpError
        spend(5 * _STEPS_OF_SYMPY)
        f = _simplify(f)
        limits = [_simplify(limit) for limit in limits]
        if any(limit.is_number and _number(limit) < -TOLERANCE for limit in limits):
            return True
        if f.is_number:
            return _number(f) > _SURELY_POSITIVE if strict else _number(f) >= -TOLERANCE
        limits = [limit for limit in limits if not limit.is_number]
        region = _region(limits, ranges)
        if region is None or _proves_at_once(f, region, strict):
            return True
        for divisor in sympy.Mul.make_args(sympy.fraction(f)[1]):
            base = divisor.as_base_exp()[0]
            if not (base.is_number or self._has_one_sign(base, limits, ranges)):
                raise GiveUpError
        return self._by_elimination(f, limits, {**ranges, **_ranges_of(region)}, strict)

    def _by_elimination(self, f: Term, limits: Sequence[Term], ranges: Ranges, strict: bool) -> bool:
        """Eliminate one variable of ``f``, and return whether ``f`` is then provably never negative.

        The variables are tried in turn, those of the lowest degree first. Raises GiveUpError if no
        variable can be eliminated.
        """

        def degree(x: Term) -> tuple[int, str]:
            return max(_degree(term, x) for term in (f, *limits)), x.name

        for x in sorted(f.free_symbols, key=degree):
            try:
                return self._eliminate(x, f, limits, ranges, strict)
            except (GiveUpError, sympy.PolynomialError, NotImplementedError):
                if self.steps > _MOST_STEPS:
                    raise
        raise GiveUpError

    def _has_one_sign(self, f: Term, limits: Sequence[Term], ranges: Ranges) -> bool:
        return any(self.proves_nonnegative(term, limits, ranges, strict=True) for term in (f, -f))

    def _eliminate(self, x: Term, f: Term, limits: Sequence[Term], ranges: Ranges, strict: bool) -> bool:
        """Whether ``f`` is provably never negative at the points where its minimum over x can lie."""
        if _degree(f, x) > LARGEST_DEGREE:
            raise GiveUpError
        rest = {symbol: side for symbol, side in ranges.items() if symbol != x}
        free = [limit for limit in limits if x not in limit.free_symbols]
        bound_to_x = [limit for limit in limits if x in limit.free_symbols]
        ends = [sympy.Rational(repr(end)) for end in ranges[x] if isfinite(end)]
        solvable = [limit for limit in bound_to_x if _is_solvable(limit, x)]
        if len(solvable) < len(bound_to_x):  # a proof on a larger region is enough
            return self.proves_nonnegative(f, [*free, *solvable], ranges, strict=strict)
        borders = [root for limit in bound_to_x for root in _border_roots(limit, x)]
        numerator = sympy.fraction(_simplify(sympy.diff(f, x)))[0]
        polynomial = sympy.Poly(numerator, x)
        factors = [sympy.Poly(factor, x) for factor, _ in sympy.factor_list(polynomial.as_expr())[1]]
        # If the leading coefficient of a factor of degree 1 is 0, either the factor has no root, or f is constant in x.
        # Then an end of the range covers it.
        for part in factors:
            may_lose_roots = part.degree() > 1 or not ends
            if may_lose_roots and not self._holds_where_zero(part.LC(), f, limits, ranges, strict):
                return False
        for candidate in dict.fromkeys([*ends, *borders, *(root for part in factors for root in _roots(part))]):
            inside = [limit.subs(x, candidate) for limit in (*bound_to_x, *_range_limits(x, ranges[x]))]
            there = [*_reality_limits(candidate), *free, *inside]
            if not self.proves_nonnegative(f.subs(x, candidate), there, rest, strict=strict):
                return False
        return all(
            self._holds_at_infinity(x, sign, f, free, limits, ranges, strict)
            for sign, end in zip((-1, 1), ranges[x], strict=True)
            if not isfinite(end)
        )

    def _holds_at_infinity(
        self, x: Term, sign: int, f: Term, free: Sequence[Term], limits: Sequence[Term], ranges: Ranges, strict: bool
    ) -> bool:
        above, below = (sympy.Poly(part, x) for part in sympy.fraction(f))
        for leading in (above.LC(), below.LC()):
            if not self._holds_where_zero(leading, f, limits, ranges, strict):
                return False
        rest = {symbol: side for symbol, side in ranges.items() if symbol != x}
        excess = above.degree() - below.degree()
        if excess < 0:
            return not strict
        limit = above.LC() / below.LC() if excess == 0 else above.LC() * below.LC() * sign**excess
        return self.proves_nonnegative(limit, free, rest, strict=strict and excess == 0)

    def _holds_where_zero(self, leading: Term, f: Term, limits: Sequence[Term], ranges: Ranges, strict: bool) -> bool:
        """Whether ``f`` is provably never negative at the points where ``leading`` is zero.

        ``leading`` is the leading coefficient of a polynomial in the variable to eliminate. Where it
        is zero, the polynomial has a lower degree, and thus other roots and other limits.
        """
        if leading.is_number:
            return True
        region = _region(limits, ranges)
        if region is None:
            return True
        for factor, _ in sympy.factor_list(leading)[1]:
            low, high = _bound(factor, region)
            if low > 0 or high < 0:
                continue
            y = min(factor.free_symbols, key=lambda symbol: (_degree(factor, symbol), symbol.name))
            if _degree(factor, y) > 1:
                raise GiveUpError
            if not self._holds_where_zero(sympy.Poly(factor, y).LC(), f, limits, ranges, strict):
                return False
            (root,) = _border_roots(factor, y)
            there = [limit.subs(y, root) for limit in (*limits, *_range_limits(y, ranges[y]))]
            rest = {symbol: bounds for symbol, bounds in ranges.items() if symbol != y}
            if not self.proves_nonnegative(f.subs(y, root), there, rest, strict=strict):
                return False
        return True


def _roots(factor: Any) -> Iterator[Term]:
    """Yield the roots of a polynomial: exact up to degree 2, otherwise only for numeric coefficients."""
    if factor.degree() in (1, 2):
        yield from sympy.roots(factor, multiple=True)
    elif factor.degree() > 2:
        if factor.free_symbols_in_domain:
            raise GiveUpError
        yield from (sympy.Rational(str(root.evalf(30))) for root in sympy.real_roots(factor))


def _is_solvable(limit: Term, x: Term) -> bool:
    above, below = sympy.fraction(limit)
    if x in below.free_symbols or not above.is_polynomial(x):
        return False
    polynomial = sympy.Poly(above, x)
    return polynomial.degree() == 1 or (polynomial.degree() == 2 and bool(polynomial.LC().is_number))


def _border_roots(limit: Term, x: Term) -> list[Term]:
    """Return the values of x at which the constraint ``limit >= 0`` begins or ceases to hold.

    The constraint must be solvable for x (:func:`_is_solvable`).
    """
    return list(sympy.roots(sympy.Poly(sympy.fraction(limit)[0], x), multiple=True))


def _range_limits(x: Term, side: Interval) -> list[Term]:
    """Return the terms ``x - low`` and ``high - x``, which are >= 0 in the range of x.

    An infinite end of the range has no term.
    """
    low, high = side
    lower = [x - sympy.Rational(repr(low))] if isfinite(low) else []
    return [*lower, sympy.Rational(repr(high)) - x] if isfinite(high) else lower


def _reality_limits(candidate: Term) -> Iterator[Term]:
    """Yield the terms that must be >= 0 for ``candidate``, the root of a polynomial, to be real."""
    for power in candidate.atoms(sympy.Pow):
        base, exponent = power.as_base_exp()
        if not exponent.is_integer:
            yield base


def _simplify(f: Term) -> Term:
    operations = f.count_ops()
    if f.has(sympy.zoo, sympy.nan, sympy.oo, sympy.I) or operations > _MOST_OPERATIONS:
        raise GiveUpError
    variables = len(f.free_symbols)
    terms = comb(variables + _total_degree(f), variables)
    if terms > _MOST_TERMS:
        raise GiveUpError
    spend(_STEPS_OF_SYMPY + 20 * operations + 10 * terms)
    return sympy.factor(sympy.together(f))


def _number(f: Term) -> float:
    value = f.evalf(30)
    if not value.is_real:
        raise GiveUpError
    number = float(value)
    if not isfinite(number) or (number == 0) != bool(value == 0):
        raise GiveUpError
    return number


def _total_degree(f: Term) -> int:
    """Return an upper bound for the degree of numerator and denominator after expansion."""
    if f.is_Add:
        return sum(_total_degree(arg) for arg in f.args if arg.is_number or not arg.is_polynomial()) + max(
            _total_degree(arg) for arg in f.args
        )
    if f.is_Mul:
        return sum(_total_degree(arg) for arg in f.args)
    if f.is_Pow:
        base, exponent = f.as_base_exp()
        return _total_degree(base) * max(1, abs(int(exponent))) if exponent.is_number else LARGEST_DEGREE
    return 1 if f.is_Symbol else 0


def _degree(f: Term, x: Term) -> int:
    above, below = sympy.fraction(f)
    if not (above.is_polynomial(x) and below.is_polynomial(x)):
        return LARGEST_DEGREE + 1
    return int(max(sympy.degree(above, x), sympy.degree(below, x)))


def _region(limits: Sequence[Term], ranges: Ranges) -> ConstrainedBox | None:
    whole = ConstrainedBox({SignalValue(symbol.name): side for symbol, side in ranges.items()}, {})
    return whole.constrain(Constraint(_expression(limit), False) for limit in limits)


def _ranges_of(region: ConstrainedBox) -> Ranges:
    return {sympy.Symbol(variable.name, real=True): side for variable, side in region.box.items()}


def _proves_at_once(f: Term, region: ConstrainedBox, strict: bool) -> bool:
    if strict:
        return _bound(f, region)[0] > 0
    return proves_within(_expression(f), region, 0.0, inf, _PARTS)


def _bound(f: Term, region: ConstrainedBox) -> Interval:
    try:
        return bound(_expression(f), region)
    except UndefinedError:
        return -inf, inf


def _expression(f: Term) -> Expression:
    """Convert a term to an expression over signals with the names of its symbols."""
    above, below = sympy.fraction(f)
    if below != 1:
        return Op("/", (_expression(above), _expression(below)))
    if f.is_Symbol:
        return SignalValue(f.name)
    if f.is_number:
        return Const(_number(f))
    if f.is_Add or f.is_Mul:
        first, *rest = (_expression(arg) for arg in f.args)
        for term in rest:
            first = Op("+" if f.is_Add else "*", (first, term))
        return first
    base, exponent = f.as_base_exp()
    if exponent.is_number and base != f:
        return Op("^", (_expression(base), Const(_number(exponent))))
    raise GiveUpError
