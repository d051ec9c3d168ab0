"""TLT0459: `keep a weak_until b`, which starts again at every step, and so means `keep a or b`."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr
from tltlc.tools.lint.file_view import FileView, ScopedExpression, operand_text, without_brackets
from tltlc.tools.lint.rule import LintRule, RuleFinding
from tltlc.tools.lint.stretches import every_step


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each `weak_until` that is a rule for every step, without a condition.

    TLT0424 reports `until` there.
    """
    for spec in view.specs:
        for clause, value in spec.clauses("keep", "require"):
            trees = every_step(clause, value)
            for tree in trees:
                if isinstance(tree, BinaryExpr) and tree.op == "W":
                    yield _finding(value.with_tree(tree), in_block=spec.declaration.block, is_whole=len(trees) == 1)


def _finding(until: ScopedExpression, *, in_block: bool, is_whole: bool) -> RuleFinding:
    assert isinstance(until.tree, BinaryExpr)
    first, end = until.children()
    either = " or ".join(_alternative(side) for side in (first, end))
    label = Label(until.source, until.tree.span, f"this means only `{either}` at every step, also after `{end.text}`")
    once, always = until.text, f"always ({either})"
    if in_block:
        once, always = f"require {once}", f"keep {either}"
    alone = "" if is_whole else " as a clause of its own"
    help_ = f"write `{once}`{alone} if it must hold once, until `{end.text}` comes; `{always}` if at every step"
    word = until.source.slice(until.tree.op_span)
    return RuleFinding(f"this `{word}` starts again at every step", (label,), help_)


def _alternative(side: ScopedExpression) -> str:
    tree = without_brackets(side.tree)
    return side.text if isinstance(tree, BinaryExpr) and tree.op == "or" else operand_text(side)


RULE = LintRule("TLT0459", "warning", check)
