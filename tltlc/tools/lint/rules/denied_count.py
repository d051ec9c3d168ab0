"""TLT0471: `times(a) >= 3 implies always for 2 s not a`, which the step of the third a already breaks."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr, CallExpr, Unary
from tltlc.tools.lint.asked_results import AskedResult, asked_results
from tltlc.tools.lint.file_view import FileView, ScopedExpression, operand_text, without_brackets
from tltlc.tools.lint.rule import LintRule, RuleFinding

_COUNTS: Final = ("times", "times_since", "times_within")
_FROM_HERE: Final = ("G", "U", "W")
"""The operators whose left or only operand is asked for at the present step, too."""


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each rule whose condition is a count, and which then forbids what is counted.

    A count comes to a number at a step with what it counts.
    """
    for spec in view.specs:
        for clause, value in spec.clauses("keep", "require"):
            for asked in asked_results(clause, value):
                event = None if asked.steps else _counted(asked.condition, view)
                if event is not None and _denied(asked.part) in (event.text, operand_text(event)):
                    yield _finding(asked, event, "keep " if asked.is_all_of(clause, value) else "")


def _counted(condition: ScopedExpression, view: FileView) -> ScopedExpression | None:
    """Return what a condition counts that says how often it has come at least."""
    tree = condition.tree
    if isinstance(tree, Unary) and tree.op == "begins":
        tree = without_brackets(tree.operand)
    if not isinstance(tree, BinaryExpr) or tree.op not in (">", ">=", "=="):
        return None
    call = without_brackets(tree.left)
    if not isinstance(call, CallExpr) or call.name not in _COUNTS or call.name in view.env.scope.names:
        return None
    return condition.with_tree(without_brackets(call.arguments[0].value))


def _denied(answer: ScopedExpression) -> str:
    """Return what an answer forbids at the present step, or ""."""
    tree = without_brackets(answer.tree)
    if isinstance(tree, Unary) and tree.op == "G":
        tree = without_brackets(tree.operand)
    elif isinstance(tree, BinaryExpr) and tree.op in _FROM_HERE:
        tree = without_brackets(tree.left)
    return answer.with_tree(tree.operand).text if isinstance(tree, Unary) and tree.op == "not" else ""


def _finding(asked: AskedResult, event: ScopedExpression, keyword: str) -> RuleFinding:
    """Return the finding for a rule; ``keyword`` is that of its clause, if the rule is all of it."""
    condition, answer, counted = asked.condition.text, asked.part.text, operand_text(event)
    label = Label(
        asked.part.source, asked.part.tree.span, f"the step at which the count comes to it has `{event.text}`"
    )
    begun = f"not {counted}" if counted.startswith("begins ") else f"not begins {counted}"
    if isinstance(asked.part.tree, Unary) and asked.part.tree.op == "not":
        later = f"previously ({condition}) implies {begun}"
    else:
        event_text = condition if condition.startswith("begins ") else f"begins ({condition})"
        later = f"{event_text} implies weak_next ({answer.replace(f'not {counted}', begun, 1)})"
    help_ = f"if no `{event.text}` may begin after it, write `{keyword}{later}`"
    return RuleFinding(f"the `{event.text}` that is counted last breaks this rule", (label,), help_)


RULE = LintRule("TLT0471", "warning", check)
