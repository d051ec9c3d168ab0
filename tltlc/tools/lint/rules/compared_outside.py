"""TLT0474: `keep mode is queue implies place <= previous(place)`, which also compares with a step before that mode."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr, CallExpr, Expr, IsExpr, NameExpr, Unary
from tltlc.grammar.walk import conjuncts, operands
from tltlc.resolve.scope import MEMORY_FUNCTIONS
from tltlc.tools.lint.asked_results import AskedResult, asked_results
from tltlc.tools.lint.file_view import FileView, ScopedExpression, without_brackets
from tltlc.tools.lint.rule import LintRule, RuleFinding
from tltlc.tools.lint.rules.first_change import has_step_before, moved, same_text

_KEPT: Final = ("<=", ">=", "==")


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each rule about steps with a state that compares a number with the step before.

    A state is the value of an enum, or a name. At its first step, the step before is without it. There is none if the
    condition is about the step before, too, nor for `<`, `>` and `!=`, which ask for a change.
    """
    for spec in view.specs:
        for clause, value in spec.clauses("keep", "require"):
            for asked in asked_results(clause, value):
                state = _state(asked)
                if state is not None and not asked.steps and _compares_with_step_before(asked.part):
                    yield _finding(asked, state, is_whole=asked.is_all_of(clause, value))


def _state(asked: AskedResult) -> ScopedExpression | None:
    """Return the test of an enum or a name in the condition of a rule; None if it is about earlier steps."""
    if has_step_before(asked.condition.tree):
        return None
    tests = [without_brackets(tree) for tree in conjuncts(asked.condition.tree)]
    values = (tree for tree in tests if isinstance(tree, IsExpr))
    state = next(values, None) or next((tree for tree in tests if _is_named(tree)), None)
    return None if state is None else asked.condition.with_tree(state)


def _is_named(tree: Expr) -> bool:
    """Whether a condition is a name, or the negation of one."""
    inner = without_brackets(tree.operand) if isinstance(tree, Unary) and tree.op == "not" else tree
    return isinstance(inner, NameExpr) or (isinstance(inner, CallExpr) and inner.name not in MEMORY_FUNCTIONS)


def _compares_with_step_before(answer: ScopedExpression) -> bool:
    """Whether an answer, or one of several that are joined by `or`, keeps a number where it was a step before."""
    for part in operands(answer.tree, "or", through_brackets=True):
        tree = without_brackets(part)
        if isinstance(tree, BinaryExpr) and tree.op in _KEPT:
            sides = [without_brackets(tree.left), without_brackets(tree.right)]
            for (one, other), sign in ((sides, 1), (sides[::-1], -1)):
                before, step = moved(other)
                if _is_before(before, one, answer) and _is_met_unchanged(tree.op, step * sign):
                    return True
    return False


def _is_met_unchanged(op: str, step: float) -> bool:
    """Whether a number that stays as it was meets `x >= previous(x) + step`."""
    return {"<=": step >= 0, ">=": step <= 0, "==": step == 0}[op]


def _is_before(call: Expr, number: Expr, answer: ScopedExpression) -> bool:
    """Whether a call is `previous(x)` of a number x."""
    if not isinstance(call, CallExpr) or call.name != "previous" or call.arguments[1:]:
        return False
    return same_text(answer, call.arguments[0].value, number)


def _finding(asked: AskedResult, state: ScopedExpression, *, is_whole: bool) -> RuleFinding:
    label = Label(
        asked.part.source, asked.part.tree.span, f"at the first step with `{state.text}`, the step before is without it"
    )
    help_ = f"if only steps within it count, add `and previously {state.text}` to that condition"
    if is_whole:
        help_ = (
            f"if only steps within it count, write "
            f"`keep {asked.condition.text} and previously {state.text} implies {asked.part.text}`"
        )
    help_ += "; if its first step counts, too, allow this with the comment `// tltlc: allow TLT0474`"
    return RuleFinding(f"this compares the first step of each `{state.text}` with the step before it", (label,), help_)


RULE = LintRule("TLT0474", "note", check)
