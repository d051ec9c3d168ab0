"""Resolve the sides of a comparison: counts and times in a sum stop where the sum passes the other side."""

from __future__ import annotations

from math import isinf

from tltlc.grammar.tree import BinaryExpr, Expr
from tltlc.grammar.walk import operands
from tltlc.resolve.dimensions import same_dimension
from tltlc.resolve.quantities import quantity
from tltlc.resolve.recall import is_open, saturate
from tltlc.resolve.values import Env, Quantity, apply


def sides(expr: BinaryExpr, env: Env, depth: int = 0) -> tuple[Quantity, Quantity]:
    """Return the quantities of both sides of a comparison.

    In ``times(p) + times(q) <= 3``, each count stops at 7, as in ``times(p) <= 3``: a sum of numbers that
    are not below 0 is above 3 where one of them is. ``depth`` is the number of operators around the
    comparison. Raises ResolutionError as `quantity` does, and TLT0303 if such a maximum is too large.
    """
    if len(_terms(expr.left)) > 1:
        right = quantity(expr.right, env, depth)
        return _sum(expr.left, right, expr.right, env, depth), right
    left = quantity(expr.left, env, depth)
    return left, _sum(expr.right, left, expr.left, env, depth)


def _terms(expr: Expr) -> list[Expr]:
    return operands(expr, "+", through_brackets=True)


def _sum(expr: Expr, other: Quantity, other_expr: Expr, env: Env, depth: int) -> Quantity:
    """Return the quantity of a sum that is compared with ``other``, or of an expression that is no sum."""
    terms = _terms(expr)
    if len(terms) < 2 or is_open(other) or isinf(other.high):
        return quantity(expr, env, depth)
    values = [quantity(term, env, depth + len(terms)) for term in terms]
    if not any(map(is_open, values)) or any(value.low < 0 for value in values):
        return quantity(expr, env, depth)
    total: Quantity | None = None
    for term, value in zip(terms, values, strict=True):
        known = saturate(value, other, other_expr, env)
        dimension = known.dimension if total is None else same_dimension(total, known, term, env)
        total = known if total is None else apply("+", (total, known), dimension)
        assert total is not None, "not constant"
    assert total is not None, "at least two terms"
    return total
