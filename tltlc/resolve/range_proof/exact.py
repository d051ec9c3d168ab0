"""Prove bounds with sympy, by turning expressions into quotients of polynomials.

A term with a function that is not a polynomial, such as ``sqrt``, becomes a variable of its own.
The range of this variable is the range that interval arithmetic finds for the term.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from math import isfinite

import sympy

from tltlc.expression.tree import Const, Expression, Op
from tltlc.resolve.range_proof.cases import Constraint, TooManyCasesError, cases
from tltlc.resolve.range_proof.elimination import LARGEST_DEGREE, GiveUpError, Prover, Term
from tltlc.resolve.range_proof.interval import Interval, UndefinedError
from tltlc.resolve.range_proof.normal_form import MOST_BITS, exact_decimal
from tltlc.resolve.range_proof.proof import ProofGoal, proves_defined, proves_within
from tltlc.resolve.range_proof.region import ConstrainedBox, bound


def proves_all(goals: Iterable[ProofGoal], whole: ConstrainedBox) -> bool:
    """Whether sympy and interval arithmetic prove all goals on the region ``whole``.

    False means only that no proof was found.
    """
    try:
        for goal in goals:
            parts = cases(goal.value, split_extremes=True)
            goal_region = whole.constrain(goal.constraints)
            if goal_region is None:
                continue
            if len(parts) > 1 and not proves_defined(goal.value, goal_region):
                return False  # splitting compares the arguments of `max`, which would hide that one is undefined
            for case in parts:
                constraints = (*goal.constraints, *case.constraints)
                region = whole.constrain(constraints)
                if region is None or proves_within(case.value, region, goal.low, goal.high):
                    continue
                if not proves_within_exactly(case.value, constraints, region, goal.low, goal.high):
                    return False
    except TooManyCasesError:
        return False
    return True


def proves_within_exactly(
    value: Expression, constraints: Sequence[Constraint], region: ConstrainedBox, low: float, high: float
) -> bool:
    """Whether ``value`` is provably defined and in ``[low, high]``, up to TOLERANCE, on a region.

    ``region`` must already be narrowed by ``constraints``, which are needed again as equations and
    inequalities for sympy. ``value`` has no ``when``.
    """
    try:
        translation, prover = _Translation(region), Prover()
        limits = [translation.term(constraint.difference) for constraint in constraints]
        term = translation.term(value)
        limits += translation.equations
        for divisor in _divisors(value):
            if not proves_defined(Op("/", (Const(1.0), divisor)), region):
                below = translation.term(divisor)
                if not any(
                    prover.proves_nonnegative(t, limits, translation.ranges, strict=True) for t in (below, -below)
                ):
                    return False
        targets = [term - sympy.Rational(exact_decimal(low))] if isfinite(low) else []
        targets += [sympy.Rational(exact_decimal(high)) - term] if isfinite(high) else []
        return all(prover.proves_nonnegative(target, limits, translation.ranges, strict=False) for target in targets)
    except (GiveUpError, UndefinedError, sympy.PolynomialError, NotImplementedError, OverflowError):
        return False


class _Translation:
    """Translates expressions to sympy terms.

    Each variable becomes a symbol, and so does each part such as ``exp(x)`` that is no quotient of
    polynomials. ``ranges`` has the range of each symbol. ``equations`` has terms that are >= 0: two
    for each square root, which say that the square of its symbol is the argument.
    """

    def __init__(self, region: ConstrainedBox) -> None:
        self.region = region
        self.ranges: dict[Term, Interval] = {}
        self.equations: list[Term] = []
        self._symbols: dict[Expression, Term] = {}

    def term(self, node: Expression) -> Term:
        if isinstance(node, Const):
            return sympy.Rational(exact_decimal(node.value))
        if isinstance(node, Op):
            exponent = node.args[-1]
            if node.op in ("+", "-", "*", "/", "neg"):
                return self._arithmetic(node)
            if node.op == "^" and isinstance(exponent, Const) and exponent.value == int(exponent.value):
                return _power(self.term(node.args[0]), int(exponent.value))
        return self._symbol(node)

    def _arithmetic(self, node: Op) -> Term:
        first, *rest = (self.term(arg) for arg in node.args)
        if node.op == "neg":
            return -first
        if node.op == "/":
            if 0 in rest:
                raise GiveUpError
            return first / sympy.prod(rest)
        return first * sympy.prod(rest) if node.op == "*" else first + sum(rest) * (1 if node.op == "+" else -1)

    def _symbol(self, node: Expression) -> Term:
        if node not in self._symbols:
            symbol = self._symbols[node] = sympy.Symbol(f"v{len(self._symbols)}", real=True)
            self.ranges[symbol] = bound(node, self.region)
            if isinstance(node, Op) and node.op == "sqrt":
                difference = self.term(node.args[0]) - symbol**2
                self.equations += [difference, -difference]
        return self._symbols[node]


def _power(base: Term, exponent: int) -> Term:
    """Return ``base ** exponent``; raise GiveUpError if the exponent or the resulting numbers are too large."""
    bits = max((number.p.bit_length() + number.q.bit_length() for number in base.atoms(sympy.Rational)), default=0)
    if abs(exponent) > LARGEST_DEGREE or bits * abs(exponent) > MOST_BITS:
        raise GiveUpError
    return base**exponent


def _divisors(value: Expression) -> Iterator[Expression]:
    """Yield the divisors in an expression, including bases of negative powers."""
    if isinstance(value, Op):
        for arg in value.args:
            yield from _divisors(arg)
        if value.op == "/":
            yield from value.args[1:]
        elif value.op == "^" and not (isinstance(value.args[1], Const) and value.args[1].value >= 0):
            yield value.args[0]
