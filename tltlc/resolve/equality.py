"""Turn ``==`` and ``!=`` of integers and counts into atoms whose robustness is scaled to [-1, 1].

``a == b`` is true where ``abs(a - b)`` is below a half, so that a value that a game computes as
1.9999999 equals 2. For whole numbers, this is equality.
"""

from __future__ import annotations

import sys
from math import inf

from tltlc.core.names import ComparisonName
from tltlc.diagnostics.diagnostic import replacement_fix
from tltlc.expression.tree import Op, SignalValue
from tltlc.grammar.mistakes.misused_operators import misused_operator
from tltlc.grammar.tree import BinaryExpr, CallExpr, Expr, GroupExpr, NameExpr
from tltlc.logic.formula import Formula, atom, not_
from tltlc.resolve import units
from tltlc.resolve.dimensions import same_dimension
from tltlc.resolve.enums import enum_of, equality_error
from tltlc.resolve.kinds import kind_of
from tltlc.resolve.margins import robustness
from tltlc.resolve.problem import ResolutionError, problem
from tltlc.resolve.recall import check_closed, check_closed_pair, saturate, too_small_error
from tltlc.resolve.registers import COUNTS
from tltlc.resolve.sums import sides
from tltlc.resolve.values import PRODUCT, Env, Quantity, apply, constant, number_text, range_text

EQUALITIES = ("==", "!=")
HALF = constant(0.5, units.PLAIN)
"""Two integers are equal where they are nearer to each other than this."""


def equality(expr: BinaryExpr, env: Env) -> Formula:
    """Return the atom of an equality of integers such as ``phase == 2``; for ``!=``, its negation.

    The robustness of the atom ``a == b`` is ``0.5 - abs(a - b)``, scaled to 1 where the two are equal
    and to -1 where they are as far apart as their ranges allow, each side of 0 on its own. For
    ``phase == 2`` with phase in [0, 5], it is 1 at 2, -0.2 at 1 and at 3, and -1 at 5.

    Raises ResolutionError if a side is no integer (TLT0110), if the ranges make the equality always or
    never true (TLT0310), if a range has an infinite end (TLT0311), or if the difference may overflow
    (TLT0319).
    """
    left, right, distance = distance_of_sides(expr, env)
    name = ComparisonName(left.operand_text(PRODUCT - 1), "==", right.operand_text(PRODUCT - 1))
    if env.symbolic:
        return atom(name)
    _check_truth(left, right, distance, expr, env)
    formula = env.context.atom(name, robustness(HALF, distance), "", env.scope.source, expr.span)
    compared = _signal_or_count(left, env)
    if compared is not None and right.is_constant:
        env.context.values_of_signals[name] = compared
    return formula if expr.op == "==" else not_(formula)


def distance_of_sides(expr: BinaryExpr, env: Env) -> tuple[Quantity, Quantity, Quantity]:
    """Return both sides of an equality of integers, a constant last, and the distance between them.

    A count that is compared with a number n stops at 2 n + 1, or at its written maximum.

    Raises ResolutionError if a side is no integer (TLT0110), or if a count stops too early (TLT0322), has
    no maximum (TLT0321) or would need too large a one (TLT0303).
    """
    for side, other in ((expr.left, expr.right), (expr.right, expr.left)):
        info = enum_of(side, env)
        if info is not None:
            raise equality_error(expr, side, info, other, env)
        if not _may_be_number(side, env):
            raise ResolutionError(misused_operator(env.scope.source, expr.op_span))
    left, right = sides(expr, env)
    same_dimension(left, right, expr.right, env)
    for time, other in ((left, expr.right), (right, expr.left)):
        if time.recall is not None and not time.recall.is_count:
            raise _time_error(time, other, expr, env)
    left, right = saturate(left, right, expr.right, env), saturate(right, left, expr.left, env)
    check_closed_pair(left, right, expr, env)
    left, right = check_closed(left, expr.left, env), check_closed(right, expr.right, env)
    at = expr.right
    if left.is_constant and not right.is_constant:
        left, right, at = right, left, expr.left
    if left.is_whole and not left.is_constant and right.is_constant and not right.is_whole:
        raise problem(
            "TLT0110",
            f"`{expr.op}` compares whole numbers, and {number_text(right.low)} is not one",
            env.scope.source,
            at.span,
            advice="write a whole number",
        )
    if left.recall is not None and left.recall.limit is not None and right.is_constant and right.low >= left.high:
        # Where the count has stopped, it may be greater.
        raise too_small_error(left, left.recall.limit, right.low)
    if not (left.is_whole and right.is_whole) or left.dimension not in (None, units.PLAIN):
        raise ResolutionError(misused_operator(env.scope.source, expr.op_span))
    if left.is_constant:
        return left, right, constant(abs(left.low - right.low), units.PLAIN)
    difference = left if right.is_constant and right.low == 0 else apply("-", (left, right), units.PLAIN)
    assert difference is not None, "not all constant"
    distance = apply("abs", (difference,), units.PLAIN)
    assert distance is not None, "not constant"
    return left, right, distance


def _signal_or_count(side: Quantity, env: Env) -> str | None:
    """Return the name of the signal or count that a side of an equality is; None for other sides."""
    value = side.expression
    if isinstance(value, SignalValue):
        return value.name
    is_limited = isinstance(value, Op) and value.op == "min" and isinstance(value.args[0], SignalValue)
    register = env.context.registers.get(value.args[0].name) if is_limited else None  # type: ignore[union-attr]
    return register.name if register is not None and register.kind in COUNTS else None


def _time_error(time: Quantity, other: Expr, expr: BinaryExpr, env: Env) -> ResolutionError:
    """Return the error for a time of the trace so far, such as ``time_since(p)``, that is compared by ``==``."""
    source = env.scope.source
    title = f"`{expr.op}` compares whole numbers, and `{time.text}` is a time"
    border = " ".join(source.slice(other.span).split())
    later = f"`{time.text} >= {border}`"
    advice = f"a time may pass {border} between two samples: write {later}, true from then on"
    if env.is_event:  # a rule whose condition stays true would ask at each later step
        begun = f"`begins ({time.text} >= {border})`, true only where {border} are over"
        advice = f"a time may pass {border} between two samples: write {begun}; {later} stays true"
    if expr.op == "!=":
        advice = f"write `{time.text} < {border}`, true before then, or `{time.text} > {border}`, true after then"
    return problem("TLT0110", title, source, expr.span, advice=advice)


def _may_be_number(expr: Expr, env: Env) -> bool:
    """Whether an expression is a number, as far as its outermost operator or name says; true for unknown names."""
    while isinstance(expr, GroupExpr):
        expr = expr.inner
    if isinstance(expr, (NameExpr, CallExpr)) and expr.name not in env.local and expr.name not in env.scope.names:
        return True
    is_local = isinstance(expr, NameExpr) and expr.name in env.local and env.symbolic
    return is_local or kind_of(expr, env) == "number"


def _check_truth(left: Quantity, right: Quantity, distance: Quantity, expr: BinaryExpr, env: Env) -> None:
    source, text = env.scope.source, f"{left.text} - {right.text}"
    if any(side.overflows for side in (left, right, distance)):
        title = f"the result of `{text}` can be too large for a number"
        label = f"a number cannot be above {sys.float_info.max:.2e}"
        advice = "declare smaller ranges for the signals and params that it is computed from"
        raise problem("TLT0319", title, source, expr.span, label, advice=advice)
    always, never = distance.high < HALF.low, distance.low >= HALF.low
    if always or never:
        holds = always == (expr.op == "==")
        word = "true" if holds else "false"
        message, advice = "both sides are constant", f"compare a signal, or write `{word}`"
        if not left.is_constant:
            message = f"`{left.text}` lies in {range_text(left.low, left.high, None)}"
            advice = f"compare with a value inside that range, or write `{word}`"
        fixes = (replacement_fix(source, expr.span, word, "safe"),)
        title = f"this comparison {'always' if holds else 'never'} holds"
        raise problem("TLT0310", title, source, expr.span, message, advice=advice, fixes=fixes)
    if distance.high == inf:
        subject = left.text if right.is_constant else f"{left.text} - {right.text}"
        title = f"`{subject}` has no range to scale this comparison by"
        advice = "declare a range with two ends, e.g. `in [0, 100]`"
        raise problem("TLT0311", title, source, expr.span, advice=advice)
