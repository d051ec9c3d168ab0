"""TLT0484: `x == 0 implies y == previous(y) - 1`, which asks for the change at each step of a state that lasts."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr, CallExpr, Expr, IsExpr
from tltlc.grammar.walk import parts
from tltlc.resolve.scope import MEMORY_FUNCTIONS
from tltlc.tools.lint.asked_results import AskedResult, asked_results
from tltlc.tools.lint.file_view import FileView, ScopedExpression, edited_text, without_brackets
from tltlc.tools.lint.rule import LintRule, RuleFinding

_SIGNS = ("<", "<=", ">", ">=", "==", "!=")


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each rule that asks for a change by an amount at the steps of a comparison or an enum."""
    for spec in view.specs:
        for clause, value in spec.clauses("keep", "require"):
            for asked in asked_results(clause, value):
                if _is_state(asked.condition.tree) and _is_change(asked.part.tree):
                    rule = without_brackets(value.tree)
                    is_whole = isinstance(rule, BinaryExpr) and without_brackets(rule.left) is asked.condition.tree
                    yield _finding(asked, value if is_whole and clause.kind == "keep" else None)


def _is_state(tree: Expr) -> bool:
    """Whether a condition is a comparison of present values, or the value of an enum: it often lasts."""
    is_compared = isinstance(tree, IsExpr) or (isinstance(tree, BinaryExpr) and tree.op in _SIGNS)
    return is_compared and not any(isinstance(part, CallExpr) and part.name in MEMORY_FUNCTIONS for part in parts(tree))


def _is_change(tree: Expr) -> bool:
    """Whether a formula says that a number has changed by an amount: `x == previous(x) - 1`."""
    if not isinstance(tree, BinaryExpr) or tree.op != "==":
        return False
    sides = [without_brackets(side) for side in (tree.left, tree.right)]
    sums = [side for side in sides if isinstance(side, BinaryExpr) and side.op in ("+", "-")]
    if len(sums) != 1:
        return False
    return any(isinstance(part, CallExpr) and part.name == "previous" for part in parts(sums[0]))


def _finding(asked: AskedResult, whole: ScopedExpression | None) -> RuleFinding:
    """Return the finding for a rule; ``whole`` is the formula of its clause, None if the rule is a part of it."""
    condition = asked.condition
    label = Label(condition.source, condition.tree.span, "at each step with this, the number must change once more")
    write = begun = f"begins ({condition.text})"
    if whole is not None:
        rule = without_brackets(whole.tree)
        assert isinstance(rule, BinaryExpr)
        write = f"keep {edited_text(whole, rule.left.span, begun)}"
    help_ = (
        f"if it must change only where this begins, write `{write}`; if each step must change it, allow this with the "
        "comment `// tltlc: allow TLT0484`"
    )
    return RuleFinding(f"this asks for the change at each step with `{condition.text}`", (label,), help_)


RULE = LintRule("TLT0484", "note", check)
