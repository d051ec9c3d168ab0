"""Refuse ``times(p) since q``, and offer ``times_since(p, q)``; in the same way for totals and greatest values."""

from __future__ import annotations

from typing import Final, TypeGuard

from tltlc.core.source import Span
from tltlc.diagnostics.diagnostic import Fix, replacement_fix
from tltlc.grammar.mistakes.compared_tests import COUNT_SINCE
from tltlc.grammar.past_words import SINCE
from tltlc.grammar.tree import BinaryExpr, CallExpr, Expr, GroupExpr, NumberExpr, Unary
from tltlc.resolve.kinds import kind_of
from tltlc.resolve.problem import problem
from tltlc.resolve.values import Env

_ORDERS: Final = ("<", "<=", ">", ">=", "==", "!=")


def check_no_count(expr: BinaryExpr, env: Env) -> None:
    """Raise ResolutionError (TLT0301) if p is a count in ``p since q``, as in ``times(p) since q <= 3``."""
    if _is_count(expr.left, env):
        advice, title = count_since_help(expr, env), "expected a formula, found a number"
        fixes = (_fix(expr, env),)
        raise problem("TLT0301", title, env.scope.source, expr.left.span, advice=advice, fixes=fixes)


def check_not_compared(expr: BinaryExpr, env: Env) -> None:
    """Raise ResolutionError (TLT0310) if q is a bool in ``p since q <= 3``, so that p is to be counted since q."""
    compared = _comparison(expr.right)
    if compared and isinstance(compared.right, NumberExpr) and kind_of(compared.left, env) == "formula":
        event = _event(expr, env)
        title = f"`{compared.op}` compares numbers, and `{event}` is true or false"
        advice = f"write `{event}` alone; {count_since_help(expr, env)}"
        raise problem("TLT0310", title, env.scope.source, compared.op_span, advice=advice)


def count_since_help(expr: BinaryExpr, env: Env) -> str:
    """Return the help for ``times(p) since q``, or for ``p since q`` where p is to be counted."""
    return COUNT_SINCE.format(function=_function(expr, env), counted=_counted(expr, env), event=_event(expr, env))


def is_count_since(expr: Expr, env: Env) -> TypeGuard[BinaryExpr]:
    """Whether an expression is ``times(p) since q``."""
    return isinstance(expr, BinaryExpr) and expr.op == "since" and _is_count(expr.left, env)


def _fix(expr: BinaryExpr, env: Env) -> Fix:
    """Return the fix that writes ``times_since(p, q)`` for an expression, which is ``times(p) since q`` so far."""
    text = f"{SINCE[_function(expr, env)]}({_counted(expr, env)}, {_event(expr, env)})"
    end = _comparison(expr.right)
    span = Span(expr.span.start, end.left.span.end if end else expr.span.end)
    return replacement_fix(env.scope.source, span, text)


def _function(expr: BinaryExpr, env: Env) -> str:
    """Return the name of the function in ``times(p) since q``; ``times`` for ``p since q``."""
    left: Expr = expr.left
    while isinstance(left, GroupExpr):
        left = left.inner
    return left.name if isinstance(left, CallExpr) and _is_count(left, env) else "times"


def _counted(expr: BinaryExpr, env: Env) -> str:
    """Return the text of p in ``times(p) since q`` and ``p since q``."""
    left: Expr = expr.left
    while isinstance(left, GroupExpr):
        left = left.inner
    counted = left.arguments[0].value if isinstance(left, CallExpr) and _is_count(left, env) else left
    return " ".join(env.scope.source.slice(counted.span).split())


def _event(expr: BinaryExpr, env: Env) -> str:
    """Return the text of q in ``p since q`` and ``p since q <= 3``."""
    compared = _comparison(expr.right)
    span = Span(expr.right.span.start, compared.left.span.end if compared else expr.right.span.end)
    return " ".join(env.scope.source.slice(span).split())


def _is_count(expr: Expr, env: Env) -> bool:
    """Whether an expression is a number by ``times``, ``total_time``, ``highest`` or ``lowest``, perhaps in brackets.

    ``highest(p)`` of a bool is no number: it is a formula.
    """
    while isinstance(expr, GroupExpr):
        expr = expr.inner
    if not isinstance(expr, CallExpr) or expr.name not in SINCE or expr.name in env.scope.names:
        return False
    of_bool = expr.name in ("highest", "lowest") and kind_of(expr.arguments[0].value, env) == "formula"
    return not of_bool


def _comparison(expr: Expr) -> BinaryExpr | None:
    """Return the comparison that an expression is, perhaps after `begins` or `ends`; else None."""
    while isinstance(expr, Unary) and expr.op in ("begins", "ends"):
        expr = expr.operand
    return expr if isinstance(expr, BinaryExpr) and expr.op in _ORDERS else None
