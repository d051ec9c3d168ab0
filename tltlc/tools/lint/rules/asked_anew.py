"""TLT0463: `times(a) >= 3 implies eventually b`, which asks for b anew at each step from the third a on."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final, TypeGuard

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr, CallExpr, Expr, Unary
from tltlc.grammar.walk import operands
from tltlc.tools.lint.asked_results import AskedResult, asked_results
from tltlc.tools.lint.file_view import FileView, ScopedExpression, without_brackets
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
    """Yield a finding for each rule with a count or a time as its condition, whose answer may come later, or lasts.

    The condition may also ask for states: ``times(a) >= 3 and c implies eventually b``.
    """
    for spec in view.specs:
        for clause, value in spec.clauses("keep", "require"):
            for asked in asked_results(clause, value):
                if _may_wait(asked) and _lasts(asked, view):
                    yield _finding(asked, "keep " if asked.is_all_of(clause, value) else "")


def _may_wait(asked: AskedResult) -> bool:
    """Whether an answer may come later, and does not end the condition as `eventually not p` ends `time_holding(p)`."""
    answer = _later_part(asked.part)
    if asked.steps or answer is None:
        return False
    goal = _goal(answer)
    if isinstance(goal, Unary) and goal.op == "G":
        return False
    return all(_goes_on(asked, goal, call) and not _is_denied(asked, answer, call) for call in _counts(asked))


def _is_denied(asked: AskedResult, answer: Unary | BinaryExpr, call: CallExpr) -> bool:
    """Whether an answer forbids from now on what is counted, which TLT0471 has."""
    now = without_brackets(answer.left if isinstance(answer, BinaryExpr) else answer.operand)
    if not isinstance(now, Unary) or now.op != "not":
        return False
    counted = asked.condition.with_tree(without_brackets(call.arguments[0].value)).text
    return asked.part.with_tree(without_brackets(now.operand)).text == counted


def _goes_on(asked: AskedResult, goal: Expr, counted: CallExpr) -> bool:
    """Whether a goal does not end a count."""
    ends = asked.condition.with_tree(without_brackets(counted.arguments[-1].value)).text
    texts = (f"not {ends}", f"not ({ends})") if counted.name == "time_holding" else (ends, f"begins {ends}")
    return asked.part.with_tree(goal).text not in texts


def _lasts(asked: AskedResult, view: FileView) -> bool:
    """Whether the condition is that a count or a time has come to a number, perhaps beside states."""
    parts = [without_brackets(part) for part in operands(without_brackets(asked.condition.tree), "and")]
    if any(isinstance(part, Unary) and part.op in ("begins", "ends") for part in parts):
        return False
    counts = _counts(asked)
    return bool(counts) and all(call.name not in view.env.scope.names for call in counts)


def _counts(asked: AskedResult) -> list[CallExpr]:
    """Return the counts and times that the condition compares with a number that they have come to."""
    compared = [without_brackets(part) for part in operands(without_brackets(asked.condition.tree), "and")]
    signs = (">", ">=", "==")
    left = [without_brackets(p.left) for p in compared if isinstance(p, BinaryExpr) and p.op in signs]
    return [call for call in left if isinstance(call, CallExpr) and call.name in _LASTING and call.arguments]


def _later_part(asked: ScopedExpression) -> Unary | BinaryExpr | None:
    """Return what may come later, or lasts: `eventually b`, alone or as in `c or (eventually b)`, or `b until c`."""
    parts = (without_brackets(part) for part in operands(without_brackets(asked.tree), "or"))
    return next((part for part in parts if _is_later(part)), None)


def _is_later(part: Expr) -> TypeGuard[Unary | BinaryExpr]:
    if isinstance(part, BinaryExpr):
        return part.op in ("U", "W")
    return isinstance(part, Unary) and (part.op == "F" or (part.op == "G" and part.bound is not None))


def _goal(answer: Unary | BinaryExpr) -> Expr:
    """Return what must come, or must last for a time."""
    return without_brackets(answer.right if isinstance(answer, BinaryExpr) else answer.operand)


def _finding(asked: AskedResult, keyword: str) -> RuleFinding:
    """Return the finding for a rule; ``keyword`` is that of its clause, if the rule is all of it."""
    condition, answer, later = asked.condition.text, asked.part, _later_part(asked.part)
    assert later is not None
    goal = answer.with_tree(_goal(later)).text
    anew = f"`{goal}` must come anew" if later.op == "F" else f"`{answer.with_tree(later).text}` is asked for anew"
    label = Label(asked.condition.source, asked.condition.tree.span, f"at each step with this, {anew}")
    help_ = (
        f"if once is enough, write `{keyword}begins ({condition}) implies {answer.text}`; if each step asks for it, "
        "allow this with the comment `// tltlc: allow TLT0463`"
    )
    return RuleFinding("this rule asks anew at each step while its condition lasts", (label,), help_)


RULE = LintRule("TLT0463", "note", check)
