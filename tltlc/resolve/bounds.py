"""Resolve the bounds of temporal operators, such as ``within 5 s`` and ``[0,20]``, to numbers of steps."""

from __future__ import annotations

from tltlc.grammar.tree import BinaryExpr, TemporalInterval, Unary
from tltlc.logic.formula import Formula, always, and_, bounded, eventually, implies, next_, then, timed, weak_next
from tltlc.resolve.constants import samples, seconds
from tltlc.resolve.problem import ResolutionError, problem
from tltlc.resolve.spec import Bound
from tltlc.resolve.values import Env


def bounded_operator(expr: Unary, operand: Formula, env: Env) -> Formula:
    """Return the bounded operator of ``expr``, applied to ``operand``.

    ``within n`` means ``[0,n]``, ``for n`` means ``[0,n-1]``, and ``next after n`` means n times
    ``next``, which is ``F[n,n]``. If ``env.unbounded`` is set, the bound of ``F`` or ``G`` is left out
    instead. With ``clock varies``, the result is the node of :func:`tltlc.logic.formula.timed`. A bound that
    begins at once has no effect before an operator that is the same without a bound: ``F[0,n] F p`` is ``F p``.

    Raises ResolutionError: TLT0312 for a bound that makes no sense, TLT0313 for a bound in seconds
    without a clock, TLT0323 for a bound that needs a fixed clock.
    """
    bound = expr.bound
    assert bound is not None
    if env.context.clock_varies:
        return _timed_operator(expr, operand, bound, env)
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
    if low == 0 and operand.op == expr.op:
        return operand
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
    if env.unbounded:
        return implies(left, eventually(right)) if expr.op == "within" else then(left, right)
    if env.context.clock_varies:
        return _timed_pair(expr, left, right, bound, env)
    high = samples(bound.high, env)
    if expr.op == "within":
        answer = bounded("F[]", 0, high, right)
        note_bound(answer, high, expr, bound, env)
        return implies(left, answer)
    if high == 0:
        advice = "`then` means at a later sample: write e.g. `then within 20 steps b`"
        raise problem("TLT0312", "`then within` needs at least one step", source, bound.high.span, advice=advice)
    rest = bounded("F[]", 0, high - 1, _goal(expr, right))
    note_bound(rest, high, expr, bound, env)
    return eventually(and_(left, next_(rest)))


def _goal(expr: BinaryExpr, right: Formula) -> Formula:
    """Return the formula that ``a then within n b`` must reach in time: another ``then`` begins with an ``F``."""
    return right.args[0] if isinstance(expr.right, BinaryExpr) and expr.right.op == "then" else right


def _timed_operator(expr: Unary, operand: Formula, bound: TemporalInterval, env: Env) -> Formula:
    """Return ``eventually within 5 s p`` or ``always for 5 s p``, where the clock varies."""
    if expr.op in ("X", "N"):
        title = "`next after` needs a fixed clock"
        advice = "write `next`, or a bound in which it must happen: `eventually within 2 s p`"
        raise problem("TLT0323", title, env.scope.source, bound.span, advice=advice)
    word = "within" if expr.op == "F" else "for"
    time = seconds(bound.high, f"{word} 2 s", env)
    if not bound.words:
        high = " ".join(env.scope.source.slice(bound.high.span).split())
        # `always for` leaves out the last sample, which `always [0 s, 2 s]` has.
        is_within = expr.op == "F" and time > 0 and (bound.low is None or bound.low.value == 0)
        advice = (
            f"write `eventually within {high}`" if is_within else "declare the rate of the game, e.g. `clock 60 Hz`"
        )
        raise problem("TLT0323", "a bound in brackets needs a fixed clock", env.scope.source, bound.span, advice=advice)
    if env.unbounded:
        return eventually(operand) if expr.op == "F" else always(operand)
    _check_above_0(time, word, bound, env)
    if operand.op == expr.op:
        return operand
    node = timed("F[]" if expr.op == "F" else "G[]", time, operand)
    note_bound(node, 0, expr, bound, env)
    return node


def _timed_pair(expr: BinaryExpr, left: Formula, right: Formula, bound: TemporalInterval, env: Env) -> Formula:
    """Return ``a then within 5 s b`` or ``within 5 s of a, b``, where the clock varies."""
    time = seconds(bound.high, "within 2 s", env)
    _check_above_0(time, "within", bound, env)
    if expr.op == "within":
        answer = timed("F[]", time, right)
        note_bound(answer, 0, expr, bound, env)
        return implies(left, answer)
    rest = timed("F[]", time, _goal(expr, right), later=True)
    note_bound(rest, 0, expr, bound, env)
    return eventually(and_(left, rest))


def _check_above_0(time: float, word: str, bound: TemporalInterval, env: Env) -> None:
    if time <= 0:
        title = f"`{word}` needs a time above 0"
        advice = f"write e.g. `{word} 2 s`"
        raise problem("TLT0312", title, env.scope.source, bound.high.span, advice=advice)


def no_timer_error(bound: Bound) -> ResolutionError:
    """Return the error for a bound that no timer can replace, which cannot become states if the clock varies."""
    advice = (
        "declare the rate of the game, e.g. `clock 60 Hz`, or use a form that a timer can decide: `reach a then within "
        "2 s b`, `keep a implies eventually within 2 s b`, `keep a implies always for 2 s b`, with `a` and `b` about "
        "one sample"
    )
    title = "this bound needs a fixed clock"
    return problem("TLT0323", title, bound.source, bound.span, "no timer can decide it here", advice=advice)


def note_bound(node: Formula, steps: int, expr: Unary | BinaryExpr, bound: TemporalInterval, env: Env) -> None:
    """Record where the bound of the operator of ``expr`` is written."""
    source = env.scope.source
    place = Bound(steps, source, bound.span, source.slice(expr.op_span), expr.op, bound.words)
    env.context.bounds.append(place)
    env.context.bound_of[node] = place


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
