"""Say a sequence such as `a then b` at the step of its last formula, in a formula about the trace so far."""

from __future__ import annotations

from typing import Final

from tltlc.diagnostics.diagnostic import Fix, replacement_fix
from tltlc.grammar.tree import BinaryExpr, Expr, GroupExpr, NameExpr, TemporalInterval
from tltlc.resolve.constants import samples
from tltlc.resolve.values import Env

_TWO_STEPS: Final = 2


def looking_back(expr: Expr, env: Env) -> Fix | None:
    """Return the fix for `a then b then c`: the same, said at the step of c; None for other formulas.

    A fix for `then within 5 s` needs steps of a fixed length; else the step of the first formula counts, too.
    """
    while isinstance(expr, GroupExpr):
        expr = expr.inner
    if not isinstance(expr, BinaryExpr) or expr.op != "then":
        return None
    text, rest = _operand_text(expr.left, env), expr
    while True:
        later = rest.right.left if isinstance(rest.right, BinaryExpr) and rest.right.op == "then" else rest.right
        text = f"{_operand_text(later, env)} and {_earlier(rest.bound, env)} {text}"
        if later is rest.right:
            break
        assert isinstance(rest.right, BinaryExpr)
        text, rest = f"({text})", rest.right
    return replacement_fix(env.scope.source, expr.span, text)


def _operand_text(expr: Expr, env: Env) -> str:
    text = " ".join(env.scope.source.slice(expr.span).split())
    return text if isinstance(expr, (NameExpr, GroupExpr)) else f"({text})"


def _earlier(bound: TemporalInterval | None, env: Env) -> str:
    """Return the operators that say at a later step of `then` that the formula before it has held in time."""
    if bound is None:
        return "previously once"
    if env.context.clock_varies:
        return f"once within {env.scope.source.slice(bound.high.span)}"
    steps = samples(bound.high, env)
    unit = "step" if steps == _TWO_STEPS else "steps"
    return f"previously once within {steps - 1} {unit}" if steps > 1 else "previously"
