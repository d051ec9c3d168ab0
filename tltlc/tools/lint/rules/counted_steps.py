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
from tltlc.tools.lint.file_view import FileView, ScopedExpression, operand_text, without_brackets
from tltlc.tools.lint.rule import LintRule, RuleFinding


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each chain of `next` that takes two or more steps, in specs and lets.

    A `next after N steps` counts as N steps.
    """
    trees = [formula.tree for spec in view.specs for formula in spec.formulas()]
    trees += [declaration.body for declaration in view.module.declarations if isinstance(declaration, LetDecl)]
    inside: set[int] = set()
    for tree in trees:
        for part in parts(tree):
            if isinstance(part, Unary) and part.op in ("X", "N") and id(part) not in inside:
                steps, awaited = _chain(part, inside)
                if steps > 1:
                    yield _finding(view, part, steps, awaited)


def _chain(first: Unary, inside: set[int]) -> tuple[float, Expr]:
    """Return how many steps a chain of `next` takes, and the operand of the last `next`.

    For `next next after 3 steps a`, these are 4 and `a`. A `next` with a bound in seconds does not
    belong to the chain. The ids of the nodes in the chain are added to ``inside``.
    """
    steps, tree = 0.0, without_brackets(first)
    while isinstance(tree, Unary) and tree.op == first.op and _steps(tree):
        inside.add(id(tree))
        steps += _steps(tree)
        tree = without_brackets(tree.operand)
    return steps, tree


def _steps(tree: Unary) -> float:
    """Return how many steps a `next` takes; 0 if its bound is in seconds."""
    if tree.bound is None:
        return 1
    return tree.bound.high.value if tree.bound.high.unit in (None, "step", "steps") else 0


def _finding(view: FileView, chain: Unary, steps: float, awaited: Expr) -> RuleFinding:
    text = operand_text(ScopedExpression(awaited, view.env))
    help_ = f"you seldom mean exactly {steps:g} steps later: declare a `clock`, and give the time in seconds"
    if view.env.context.clock_s:
        time = _seconds(steps, view.env.context.clock_s, view.env)
        if chain.op == "N":
            help_ = f"give the time in seconds: `weak_next after {time} s {text}`"
        else:
            help_ = f"give the time in seconds: `next after {time} s {text}`"
            help_ += f", or `eventually within {time} s {text}` if it may come earlier"
    label = Label(view.source, Span(chain.span.start, awaited.span.start), f"exactly {steps:g} steps from now")
    return RuleFinding("this counts steps, however long they take", (label,), help_)


def _seconds(steps: float, period: float, env: Env) -> str:
    """Return a short decimal number of seconds that the compiler turns into exactly this many steps.

    ``period`` is the length of a step in seconds. The compiler rounds times up to whole steps, so
    the result may be a little less than ``steps * period``.
    """
    exact = steps * period
    shorter = (str(Context(prec=digits, rounding=ROUND_DOWN).create_decimal(exact)) for digits in range(3, 18))
    texts = [f"{exact:.6g}", *shorter]
    return next((text for text in texts if samples(NumberExpr(float(text), "s", Span(0, 0)), env) == steps), texts[-1])


RULE = LintRule("TLT0418", "warning", check)
