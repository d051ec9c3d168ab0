"""Expand temporal operators with bounds: ``F[0,2] p`` becomes ``p | X(p | X p)``."""

from __future__ import annotations

from tltlc.grammar.tree import Unary
from tltlc.logic.formula import Formula, always, and_, eventually, next_, or_, weak_next
from tltlc.resolve.constants import samples
from tltlc.resolve.context import LARGEST_EXPANSION, expansion_error
from tltlc.resolve.problem import problem
from tltlc.resolve.spec import Bound
from tltlc.resolve.values import Env


def expand_bound(expr: Unary, operand: Formula, env: Env) -> Formula:
    """Return the bounded operator of ``expr``, applied to ``operand``, as a formula without bounds.

    ``F`` expands to ``X`` (strong next), so ``F[a,b] p`` is false past the end of the trace. ``G``
    expands to ``N`` (weak next), so ``G[a,b] p`` requires nothing there. ``within n`` means
    ``[0,n]``, ``for n`` means ``[0,n-1]``, and ``next after n`` means n times ``next``. If
    ``env.unbounded`` is set, the bound of ``F`` or ``G`` is left out instead.

    Raises ResolutionError: TLT0312 for a bound that makes no sense, TLT0313 for a bound in seconds
    without a clock, TLT0315 if the formula becomes too large.
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
    subject = f"the bound of `{source.slice(expr.op_span)}`"
    if 2 * high + (high - low + 1) * env.context.tree_size(operand) > 2 * LARGEST_EXPANSION:
        raise expansion_error(subject, source, bound.span, is_bound=True)
    env.context.bounds.append(Bound(high, source, bound.span))
    result = operand
    join, step = (and_, weak_next) if expr.op == "G" else (or_, weak_next if expr.op == "N" else next_)
    for _ in range(high - low):
        result = join(operand, step(result))
    for _ in range(low):
        result = step(result)
    return env.context.check_size(result, subject, source, bound.span, is_bound=True)


def _drop_bound(op: str, steps: int, operand: Formula) -> Formula:
    """Return ``F operand`` or ``G operand``, as if the operator had no bound.

    ``X`` and ``N`` have no bound to leave out: they are applied ``steps`` times.
    """
    if op in ("F", "G"):
        return eventually(operand) if op == "F" else always(operand)
    for _ in range(steps):
        operand = next_(operand) if op == "X" else weak_next(operand)
    return operand
