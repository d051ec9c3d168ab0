"""Counts and times of the trace so far as quantities: find or check the maximum at which they stop."""

from __future__ import annotations

from math import ceil, isinf
from typing import Final

from tltlc.core.record import replace
from tltlc.core.source import Span
from tltlc.diagnostics.diagnostic import Edit, Fix, Label, replacement_fix
from tltlc.expression.tree import Const, Expression, Op
from tltlc.grammar.tree import BinaryExpr, CallExpr, Expr
from tltlc.grammar.walk import parts
from tltlc.resolve import registers, units
from tltlc.resolve.counts_within import MOST_BEGINNINGS
from tltlc.resolve.problem import ResolutionError, problem
from tltlc.resolve.values import Env, Quantity, number_text

_ARGUMENTS: Final = {
    "times": 1,
    "times_since": 2,
    "times_within": 2,
    "total_time": 1,
    "total_time_since": 2,
    "time_since": 1,
    "time_holding": 1,
}
"""The counts and times that may have a maximum, and how many arguments they have without one."""
_SEVERAL: Final = 2
MOST_STEPS: Final = 10**9
"""The greatest maximum that a count or time may have, in steps."""


def up_to(
    value: Quantity, maximum: float, expr: Expr, env: Env, text: str | None = None, limit: Label | None = None
) -> Quantity:
    """Return a recalled quantity up to a maximum, which is rounded up to whole steps on a fixed clock.

    ``expr`` is the expression that gives the maximum, and ``text`` the spelling of the new quantity, by
    default the old one. ``limit`` is the place where the maximum is written, if it is. Raises
    ResolutionError (TLT0303) if the maximum is too large.
    """
    read = value.recall
    assert read is not None, "a quantity that saturates"
    if read.window is not None and maximum > MOST_BEGINNINGS:
        title = f"`{value.text}` would need a maximum above {MOST_BEGINNINGS}"
        advice = f"compare it with less than {MOST_BEGINNINGS // 2}, or let the game count and supply the number"
        if limit is not None:
            advice = f"write a maximum of at most {MOST_BEGINNINGS}, or let the game count and supply the number"
        raise problem("TLT0303", title, env.scope.source, expr.span, advice=advice)
    if maximum > MOST_STEPS * float(read.unit):
        most = number_text(MOST_STEPS * float(read.unit)) + ("" if read.is_count else " s")
        title = f"`{value.text}` would need a maximum above {most}"
        advice = "choose a smaller number" if read.is_count else "choose a shorter time, or a slower clock"
        raise problem("TLT0303", title, env.scope.source, expr.span, advice=advice)
    steps = max(1, ceil(maximum / float(read.unit) - 1e-9)) if read.is_whole else maximum or 1.0
    if read.window is not None and not env.symbolic:
        read.window.register(read.register, int(steps), env.context, env.scope.source, expr.span)
    expression: Expression = registers.saturated(read.register, steps)
    # Multiply and divide by whole numbers, so that 3 steps of 0.15 s are exactly the number 0.45.
    over, under = float(read.unit.numerator), float(read.unit.denominator)
    if over != 1.0:
        expression = Op("*", (expression, Const(over)))
    if under != 1.0:
        expression = Op("/", (expression, Const(under)))
    known = None if limit is None else replace(read, limit=limit)
    high = steps * over / under
    return replace(value, expression=expression, high=high, text=text or value.text, recall=known, depth=4)


def saturate(value: Quantity, other: Quantity, expr: Expr, env: Env) -> Quantity:
    """Give a recalled quantity that is compared with ``other`` the least maximum that keeps the comparison exact.

    This is twice the greatest value of ``other``, and for counts one more, so that the robustness has
    equal room on both sides. The quantity is returned as it is if it has a maximum, or if ``other``
    has no greatest value. ``expr`` is the expression of ``other``. Raises ResolutionError (TLT0303) if
    the maximum is too large.
    """
    if not is_open(value) or isinf(other.high):
        return value
    assert value.recall is not None, "an open quantity"
    return up_to(value, 2 * max(other.high, 0.0) + value.recall.is_count, expr, env)


def is_open(value: Quantity) -> bool:
    """Whether a quantity is a count or time whose maximum is not yet known."""
    return value.recall is not None and value.recall.limit is None


def check_closed(value: Quantity, expr: Expr, env: Env) -> Quantity:
    """Return a quantity that has a maximum.

    Raises ResolutionError (TLT0321) if it is recalled, and neither has a maximum nor a greatest value.
    """
    if env.symbolic or not is_open(value):
        return value
    assert value.recall is not None, "an open quantity"
    if value.recall.most is not None:
        return up_to(value, value.recall.most, expr, env)
    stops = f"{'counting' if value.recall.is_count else 'the time'} stops at the maximum"
    written = f"`{_closed_text(value, env, expr)}`"
    advice = f"write the greatest value that matters, e.g. {written}: {stops}"
    if not value.recall.is_count and env.context.limit_text:
        advice = f"write {written}, with the limit of the spec, or a longer time: {stops}"
    raise _open_error(value, expr, env, advice)


def check_closed_pair(left: Quantity, right: Quantity, expr: BinaryExpr, env: Env) -> None:
    """Raise ResolutionError (TLT0321) if both sides of a comparison are recalled and have no maximum."""
    if env.symbolic or not (is_open(left) and is_open(right)):
        return
    text = f"{_closed_text(left, env, expr.left)} {expr.op} {_closed_text(right, env, expr.right)}"
    advice = (
        f"write the greatest value that one play can reach on both sides, e.g. `{text}`: from there on, both stay at "
        "it, and no difference is seen"
    )
    raise _open_error(left, expr.left, env, advice)


def _closed_text(value: Quantity, env: Env, expr: Expr) -> str:
    """Return the text of a recalled quantity with a maximum: the limit of the spec for a time, else an example."""
    assert value.recall is not None, "an open quantity"
    example = env.context.limit_text or "60 s"
    if value.recall.is_count:
        example = "1000" if value.recall.window is None else str(MOST_BEGINNINGS)
    is_own = isinstance(expr, CallExpr) and expr.name == value.text.partition("(")[0]
    text = " ".join(env.scope.source.slice(expr.span).split()) if is_own else value.text
    return f"{text[:-1]}, {example})"


def _open_error(value: Quantity, expr: Expr, env: Env, advice: str) -> ResolutionError:
    """Return the error for a recalled quantity that needs a maximum."""
    return problem(
        "TLT0321",
        f"`{value.text}` needs a maximum here",
        env.scope.source,
        expr.span,
        "only a comparison of it, or of a sum, with a number finds one by itself",
        advice=advice,
    )


def with_all_maxima(error: ResolutionError, expr: BinaryExpr, env: Env) -> ResolutionError:
    """Return an error for a count without a maximum with the maxima of all counts and times of its comparison."""
    diagnostic = error.diagnostic
    calls = [part for part in parts(expr) if isinstance(part, CallExpr) and _may_be_open(part, env)]
    if diagnostic is None or diagnostic.code != "TLT0321" or len(calls) < _SEVERAL:
        return error
    source, edits = env.scope.source, []
    for call in sorted(calls, key=lambda call: call.span.end):
        most = env.context.limit_text or "60 s"
        if call.name.startswith("times"):
            most = str(MOST_BEGINNINGS) if call.name == "times_within" else "1000"
        edits.append(Edit(Span(call.span.end - 1, call.span.end - 1), f", {most}"))
    text, at = "", expr.span.start
    for edit in edits:
        text, at = text + source.text[at : edit.span.start] + edit.text, edit.span.end
    text = " ".join((text + source.text[at : expr.span.end]).split())
    help_ = (
        f"write the greatest value that one play can reach in each, e.g. `{text}`: from there on, they stay at it, and "
        "no difference is seen"
    )
    return ResolutionError(replace(diagnostic, help=help_, fixes=(Fix(f"Write `{text}`", tuple(edits)),)))


def _may_be_open(call: CallExpr, env: Env) -> bool:
    """Whether a call is a count or a time without a maximum."""
    return call.name in _ARGUMENTS and len(call.arguments) == _ARGUMENTS[call.name] and call.name not in env.scope.names


def too_small_error(value: Quantity, limit: Label, needed: float) -> ResolutionError:
    """Return the error for a comparison with a number that the written maximum of a quantity does not reach."""
    text = number_text(ceil(2 * needed + 1)) if value.dimension == units.PLAIN else f"{number_text(2 * needed)} s"
    title = f"the maximum of `{value.text}` is too small for this comparison"
    fixes = (replacement_fix(limit.source, limit.span, text),)
    advice = f"write `{text}`, or leave the maximum out"
    return problem("TLT0322", title, limit.source, limit.span, "it stops here", advice=advice, fixes=fixes)
