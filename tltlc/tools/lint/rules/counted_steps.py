"""TLT0418: several `next` in a row, which count the steps of the game."""

from __future__ import annotations

from collections.abc import Iterator
from decimal import ROUND_DOWN, Context

from tltlc.core.source import Span
from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import Expr, LetDecl, NumberExpr, Unary
from tltlc.grammar.walk import parts
from tltlc.resolve.constants import samples
from tltlc.resolve.values import Env
from tltlc.tools.lint.file_view import Expression, View, inner, operand
from tltlc.tools.lint.rule import LintRule, Remark


def check(view: View) -> Iterator[Remark]:
    """Yield a remark for each chain of two or more `next`, in specs and lets.

    `next after` counts as that many steps.
    """
    trees = [formula.tree for spec in view.specs for formula in spec.formulas()]
    trees += [declaration.body for declaration in view.module.declarations if isinstance(declaration, LetDecl)]
    inside: set[int] = set()
    for tree in trees:
        for part in parts(tree):
            if isinstance(part, Unary) and part.op in ("X", "N") and id(part) not in inside:
                steps, awaited = _chain(part, inside)
                if steps > 1:
                    yield _remark(view, part, steps, awaited)


def _chain(first: Unary, inside: set[int]) -> tuple[float, Expr]:
    """Return how many steps a chain takes, and the expression at its end.

    A `next` with a bound in seconds ends the chain. Adds the ids of the chain's nodes to
    ``inside``.
    """
    steps, tree = 0.0, inner(first)
    while isinstance(tree, Unary) and tree.op == first.op and _steps(tree):
        inside.add(id(tree))
        steps += _steps(tree)
        tree = inner(tree.operand)
    return steps, tree


def _steps(tree: Unary) -> float:
    if tree.bound is None:
        return 1
    return tree.bound.high.value if tree.bound.high.unit in (None, "step", "steps") else 0


def _remark(view: View, chain: Unary, steps: float, awaited: Expr) -> Remark:
    text = operand(Expression(awaited, view.env))
    suggestion = f"exactly {steps:g} steps later is seldom meant: declare a `clock`, and say it in seconds"
    if view.env.context.clock_s:
        time = _seconds(steps, view.env.context.clock_s, view.env)
        if chain.op == "N":
            suggestion = f"say it in seconds: `weak_next after {time} s {text}`"
        else:
            suggestion = f"say it in seconds: `next after {time} s {text}`"
            suggestion += f", or `eventually within {time} s {text}` where it may come earlier"
    label = Label(view.source, Span(chain.span.start, awaited.span.start), f"exactly {steps:g} steps from now")
    return Remark("this counts steps, whatever time they take", (label,), suggestion)


def _seconds(steps: float, period: float, env: Env) -> str:
    """Return a short time in seconds that covers exactly this many steps.

    Times round up to steps, so the result is never longer than the exact time.
    """
    exact = steps * period
    shorter = (str(Context(prec=digits, rounding=ROUND_DOWN).create_decimal(exact)) for digits in range(3, 18))
    texts = [f"{exact:.6g}", *shorter]
    return next((text for text in texts if samples(NumberExpr(float(text), "s", Span(0, 0)), env) == steps), texts[-1])


RULE = LintRule("TLT0418", "warning", check)
