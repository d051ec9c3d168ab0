"""TLT0474: `keep mode is queue implies place <= previous(place)`, which also compares with a step in another mode."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr, CallExpr, Expr, IsExpr
from tltlc.grammar.walk import conjuncts
from tltlc.tools.lint.asked_results import AskedResult, asked_results
from tltlc.tools.lint.file_view import FileView, ScopedExpression, without_brackets
from tltlc.tools.lint.rule import LintRule, RuleFinding
from tltlc.tools.lint.rules.first_change import has_step_before, moved, same_text

_KEPT: Final = ("<=", ">=", "==")


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each rule about steps with a value of an enum that compares a number with the step before.

    At the first step with the value, the step before has another. There is none if the condition is about the step
    before, too, nor for `<`, `>` and `!=`, which ask for a change.
    """
    for spec in view.specs:
        for clause, value in spec.clauses("keep", "require"):
            for asked in asked_results(clause, value):
                state = _state(asked)
                if state is not None and not asked.steps and _compares_with_step_before(asked.part):
                    yield _finding(asked, state, is_whole=asked.is_all_of(clause, value))


def _state(asked: AskedResult) -> ScopedExpression | None:
    """Return the test of an enum in the condition of a rule; None if there is none, or it is about earlier steps."""
    if has_step_before(asked.condition.tree):
        return None
    tests = (without_brackets(tree) for tree in conjuncts(asked.condition.tree))
    return next((asked.condition.with_tree(tree) for tree in tests if isinstance(tree, IsExpr)), None)


def _compares_with_step_before(answer: ScopedExpression) -> bool:
    tree = without_brackets(answer.tree)
    if not isinstance(tree, BinaryExpr) or tree.op not in _KEPT:
        return False
    sides = [without_brackets(tree.left), without_brackets(tree.right)]
    return any(_is_before(moved(other)[0], one, answer) for one, other in (sides, sides[::-1]))


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
