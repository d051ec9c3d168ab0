"""TLT0475: `keep mode is rush implies time_since(order) <= 20 s`, which asks for an order before the first rush."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr, CallExpr, Clause, Expr, IsExpr, NumberExpr
from tltlc.grammar.walk import conjuncts
from tltlc.tools.lint.asked_results import asked_results
from tltlc.tools.lint.file_view import FileView, ScopedExpression, operand_text, without_brackets
from tltlc.tools.lint.rule import LintRule, RuleFinding
from tltlc.tools.lint.rules.first_change import has_step_before

_OPPOSITE: Final = {"<=": ">", "<": ">=", ">": ">", ">=": ">="}
"""Maps the sign of a time that is kept, or avoided, to that of the time that is avoided."""


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each rule that no more than a time has passed since an event, while an enum has a value.

    Before the first event, the time is over every limit. So the rule breaks at the first step with the value if the
    event has not come. There is none if the condition says what has been.
    """
    for spec in view.specs:
        for clause, value in spec.clauses("keep", "avoid"):
            for condition, limit in _limits(clause, value):
                state = next((tree for tree in conjuncts(condition.tree) if isinstance(tree, IsExpr)), None)
                if state is not None and not has_step_before(condition.tree):
                    yield _finding(condition, limit)


def _limits(clause: Clause, value: ScopedExpression) -> Iterator[tuple[ScopedExpression, ScopedExpression]]:
    """Yield the condition and the comparison of each limit of `time_since(p)` in a clause."""
    if clause.kind == "keep":
        for asked in asked_results(clause, value):
            if not asked.steps and _is_limit(asked.part.tree, ("<=", "<")):
                yield asked.condition, asked.part
        return
    trees = [without_brackets(tree) for tree in conjuncts(without_brackets(value.tree))]
    limits = [tree for tree in trees if _is_limit(tree, (">", ">="))]
    if len(trees) == 2 and len(limits) == 1:
        (other,) = (tree for tree in trees if tree is not limits[0])
        yield value.with_tree(other), value.with_tree(limits[0])


def _is_limit(tree: Expr, signs: tuple[str, ...]) -> bool:
    tree = without_brackets(tree)
    return (
        isinstance(tree, BinaryExpr)
        and tree.op in signs
        and isinstance(tree.left, CallExpr)
        and tree.left.name == "time_since"
        and isinstance(tree.right, NumberExpr)
    )


def _finding(condition: ScopedExpression, limit: ScopedExpression) -> RuleFinding:
    tree = without_brackets(limit.tree)
    assert isinstance(tree, BinaryExpr) and isinstance(tree.left, CallExpr)
    event, time = limit.with_tree(tree.left.arguments[0].value), limit.with_tree(tree.right).text
    label = Label(limit.source, tree.span, f"before the first `{event.text}`, its time is over every limit")
    help_ = (
        f"if the time also counts from where `{condition.text}` begins, write "
        f"`avoid time_holding({condition.text} and not {operand_text(event)}) {_OPPOSITE[tree.op]} {time}`; "
        f"if `{event.text}` must come before, allow this with the comment `// tltlc: allow TLT0475`"
    )
    return RuleFinding(f"`{condition.text}` breaks this before the first `{event.text}`", (label,), help_)


RULE = LintRule("TLT0475", "note", check)
