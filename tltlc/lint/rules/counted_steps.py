"""TLT0418: several `next` in a row, which count the steps of the game."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import Expr, LetDecl, Unary
from tltlc.grammar.walk import parts
from tltlc.lint.rule import Remark, Rule
from tltlc.lint.view import Expression, View, inner, operand
from tltlc.source import Span


def check(view: View) -> Iterator[Remark]:
    """A remark for each chain of two or more `next`, or `next after` of as many steps, in specs and lets."""
    trees = [formula.tree for spec in view.specs for formula in spec.formulas()]
    trees += [each.body for each in view.module.declarations if isinstance(each, LetDecl)]
    inside: set[int] = set()
    for tree in trees:
        for part in parts(tree):
            if isinstance(part, Unary) and part.op in ("X", "N") and id(part) not in inside:
                steps, awaited = _chain(part, inside)
                if steps > 1:
                    yield _remark(view, part, steps, awaited)


def _chain(first: Unary, inside: set[int]) -> tuple[float, Expr]:
    """How many steps a chain takes, and what comes then; those that count on by seconds end it."""
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
    clock = view.env.context.clock_s
    way_out = f"exactly {steps:g} steps later is seldom meant: declare a `clock`, and say it in seconds"
    if clock:
        way_out = f"say it in seconds: `eventually within {clock * steps:.6g} s {text}`"
    label = Label(view.source, Span(chain.span.start, awaited.span.start), f"exactly {steps:g} steps from now")
    return Remark("this counts steps, whatever time they take", (label,), way_out)


RULE = Rule("TLT0418", "warning", check)
