"""TLT0463: `times(a) >= 3 implies eventually b`, which asks for b anew at each step from the third a on."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr, CallExpr, Unary
from tltlc.tools.lint.asked_results import AskedResult, asked_results
from tltlc.tools.lint.file_view import FileView, without_brackets
from tltlc.tools.lint.rule import LintRule, RuleFinding

_LASTING: Final = (
    "times",
    "times_since",
    "times_within",
    "time_since",
    "time_holding",
    "total_time",
    "total_time_since",
)
"""The functions that stay at a number, or above it, once they have come to it."""


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each rule whose only condition is a count or a time, and whose answer may come later."""
    for spec in view.specs:
        for clause, value in spec.clauses("keep", "require"):
            for asked in asked_results(clause, value):
                if _may_wait(asked) and _lasts(asked, view):
                    rule = without_brackets(value.tree)
                    is_whole = isinstance(rule, BinaryExpr) and without_brackets(rule.left) is asked.condition.tree
                    yield _finding(asked, "keep " if clause.kind == "keep" and is_whole else "")


def _may_wait(asked: AskedResult) -> bool:
    """Whether an answer may come later, and does not end the condition as `eventually not p` ends `time_holding(p)`."""
    answer, condition = asked.part.tree, asked.condition.tree
    if asked.steps or not isinstance(answer, Unary) or answer.op != "F" or not isinstance(condition, BinaryExpr):
        return False
    goal, counted = without_brackets(answer.operand), without_brackets(condition.left)
    if isinstance(goal, Unary) and goal.op == "G":
        return False
    if not isinstance(counted, CallExpr) or not counted.arguments:
        return False
    ends = asked.condition.with_tree(without_brackets(counted.arguments[-1].value)).text
    texts = (f"not {ends}", f"not ({ends})") if counted.name == "time_holding" else (ends, f"begins {ends}")
    return asked.part.with_tree(goal).text not in texts


def _lasts(asked: AskedResult, view: FileView) -> bool:
    """Whether the condition is that a count or a time has come to a number."""
    condition = asked.condition.tree
    if not isinstance(condition, BinaryExpr) or condition.op not in (">", ">=", "=="):
        return False
    counted = without_brackets(condition.left)
    return isinstance(counted, CallExpr) and counted.name in _LASTING and counted.name not in view.env.scope.names


def _finding(asked: AskedResult, keyword: str) -> RuleFinding:
    """Return the finding for a rule; ``keyword`` is that of its clause, if the rule is all of it."""
    condition, answer = asked.condition.text, asked.part
    assert isinstance(answer.tree, Unary)
    goal = answer.with_tree(without_brackets(answer.tree.operand)).text
    label = Label(asked.condition.source, asked.condition.tree.span, f"at each step with this, `{goal}` must come anew")
    help_ = (
        f"if once is enough, write `{keyword}begins ({condition}) implies {answer.text}`; if each step asks for it, "
        "allow this with the comment `// tltlc: allow TLT0463`"
    )
    return RuleFinding("this rule asks anew at each step while its condition lasts", (label,), help_)


RULE = LintRule("TLT0463", "note", check)
