"""Resolve the bounds of temporal operators, such as ``within 5 s`` and ``[0,20]``, to numbers of steps."""

from __future__ import annotations

from tltlc.grammar.tree import BinaryExpr, TemporalInterval, Unary
from tltlc.logic.formula import Formula, always, and_, bounded, eventually, implies, next_, then, weak_next
from tltlc.resolve.constants import samples
from tltlc.resolve.problem import problem
from tltlc.resolve.spec import Bound
from tltlc.resolve.values import Env


def bounded_operator(expr: Unary, operand: Formula, env: Env) -> Formula:
    """Return the bounded operator of ``expr``, applied to ``operand``.

    ``within n`` means ``[0,n]``, ``for n`` means ``[0,n-1]``, and ``next after n`` means n times
    ``next``, which is ``F[n,n]``. If ``env.unbounded`` is set, the bound of ``F`` or ``G`` is left out
    instead.

    Raises ResolutionError: TLT0312 for a bound that makes no sense, TLT0313 for a bound in seconds
    without a clock.
    """
    bound = expr.bound
    assert bound is not None
    if env.unbounded:
        return _drop_bound(expr.op, samples(bound.high, env), operand)
    source = env.scope.source
    high = samples(bound.high, env)
    low = samples(bound.low, env) if bound.low is not None else 0
    if expr.op in ("X", "N"):
        low = high
    elif bound.words and expr.op == "G":
        if high == 0:
            advice = "write e.g. `always for 20 steps p`"
            raise problem("TLT0312", "`for` needs at least one step", source, bound.high.span, advice=advice)
        high -= 1
    if low > high:
        advice = "write the smaller number first, e.g. `[0, 20]`"
        raise problem("TLT0312", "this bound ends before it begins", source, bound.span, advice=advice)
    node = bounded("F[]" if expr.op in ("F", "X") else "G[]", low, high, operand)
    note_bound(node, high, expr, bound, env)
    return node


def with_bound(expr: BinaryExpr, left: Formula, right: Formula, env: Env) -> Formula:
    """Return the formula of ``a then within n b`` or ``within n of a, b``.

    The first is ``F(a & X F[0,n-1] b)``: b holds at one of the n samples after a. The second is
    ``a -> F[0,n] b``: b holds at the same sample as a, or at one of the n after it.

    Raises ResolutionError: TLT0312 for a bound that makes no sense, TLT0313 for a bound in seconds
    without a clock.
    """
    bound, source = expr.bound, env.scope.source
    assert bound is not None, "a bound"
    high = samples(bound.high, env)
    if expr.op == "within":
        answer = eventually(right) if env.unbounded else bounded("F[]", 0, high, right)
        note_bound(answer, high, expr, bound, env)
        return implies(left, answer)
    if env.unbounded:
        return then(left, right)
    if high == 0:
        advice = "`then` means at a later sample: write e.g. `then within 20 steps b`"
        raise problem("TLT0312", "`then within` needs at least one step", source, bound.high.span, advice=advice)
    # Another `then` begins with an `F`, whose place the bound takes.
    goal = right.args[0] if isinstance(expr.right, BinaryExpr) and expr.right.op == "then" else right
    rest = bounded("F[]", 0, high - 1, goal)
    note_bound(rest, high, expr, bound, env)
    return eventually(and_(left, next_(rest)))


def note_bound(node: Formula, steps: int, expr: Unary | BinaryExpr, bound: TemporalInterval, env: Env) -> None:
    """Record where the bound of the operator of ``expr`` is written."""
    source = env.scope.source
    place = Bound(steps, source, bound.span, source.slice(expr.op_span), expr.op, bound.words)
    env.context.bounds.append(place)
    env.context.bound_of.setdefault(node, place)


def _drop_bound(op: str, steps: int, operand: Formula) -> Formula:
    """Return ``F operand`` or ``G operand``, as if the operator had no bound.

    ``X`` and ``N`` have no bound to leave out. They are applied once, unless ``steps`` is 0: how often
    makes no difference to when a spec is judged.
    """
    if op in ("F", "G"):
        return eventually(operand) if op == "F" else always(operand)
    if steps == 0:
        return operand
    return next_(operand) if op == "X" else weak_next(operand)
