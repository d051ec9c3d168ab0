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
    """Yield a finding for each chain of two or more `next`, in specs and lets.

    A `next after 3 steps` is no part of a chain: who writes the number of steps means it.
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


def _chain(first: Unary, inside: set[int]) -> tuple[int, Expr]:
    """Return how many `next` a chain has, and the operand of the last one: 2 and `a` for `next next a`.

    The ids of the nodes in the chain are added to ``inside``.
    """
    steps, tree = 0, without_brackets(first)
    while isinstance(tree, Unary) and tree.op == first.op and tree.bound is None:
        inside.add(id(tree))
        steps += 1
        tree = without_brackets(tree.operand)
    return steps, tree


def _finding(view: FileView, chain: Unary, steps: int, awaited: Expr) -> RuleFinding:
    text = operand_text(ScopedExpression(awaited, view.env))
    word = "weak_next" if chain.op == "N" else "next"
    context = view.env.context
    help_ = f"if exactly {steps} steps are meant, write `{word} after {steps} steps {text}`; if a time is meant, "
    if context.clock_varies:
        # `next after` needs a fixed clock.
        help_ = f"if a time is meant, give it in seconds, e.g. `eventually within 0.2 s {text}`"
    elif context.clock_s:
        time = _seconds(steps, context.clock_s, view.env)
        help_ += f"give it in seconds: `{word} after {time} s {text}`"
        if chain.op == "X":
            help_ += f", or `eventually within {time} s {text}` if it may come earlier"
    else:
        help_ += "declare a `clock`, and give it in seconds"
    label = Label(view.source, Span(chain.span.start, awaited.span.start), f"exactly {steps} steps from now")
    return RuleFinding("this counts steps, however long they take", (label,), help_)


def _seconds(steps: int, period: float, env: Env) -> str:
    """Return a short decimal number of seconds that the compiler turns into exactly this many steps.

    ``period`` is the length of a step in seconds. The compiler rounds times up to whole steps, so
    the result may be a little less than ``steps * period``.
    """
    exact = steps * period
    shorter = (str(Context(prec=digits, rounding=ROUND_DOWN).create_decimal(exact)) for digits in range(3, 18))
    texts = [f"{exact:.6g}", *shorter]
    return next((text for text in texts if samples(NumberExpr(float(text), "s", Span(0, 0)), env) == steps), texts[-1])


RULE = LintRule("TLT0418", "warning", check)
