"""TLT0449: `keep a implies next b`, which also asks for a step after a."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltlc.automaton.default_judge import default_judge
from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr, Unary
from tltlc.tools.lint.asked_results import AskedResult, Rewriting, asked_results
from tltlc.tools.lint.file_view import FileView, ScopedExpression, without_brackets
from tltlc.tools.lint.rule import LintRule, RuleFinding

_AWAITING: Final = ("F", "U", "M", "X", "then", "within")
"""The operators that ask for something that may come later."""


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each condition after which a rule for every step asks for a `next`.

    There is none for `next eventually b`, which is about more than the next step, nor if the spec accepts no play
    that ends at the condition. TLT0418 reports several `next` in a row. Who writes `next after 3 steps` means the
    number of steps. Over infinite traces, there is always a next step.
    """
    for spec in view.specs:
        if spec.spec.semantics != "finite":
            continue
        for clause, value in spec.clauses("keep", "require"):
            by_condition: dict[str, list[ScopedExpression]] = {}
            for result in asked_results(clause, value):
                if _asks_for_one_step(result):
                    by_condition.setdefault(result.condition.text, []).append(result.part)
            rewriting = Rewriting(clause, value, spec)
            for condition, steps in by_condition.items():
                others = [step for same in by_condition.values() if same is not steps for step in same]
                if rewriting.differs(steps, others):
                    yield _finding(rewriting, condition, steps)


def _asks_for_one_step(result: AskedResult) -> bool:
    """Whether a result is a `next` without a bound, of something that asks for no further step."""
    tree = result.part.tree
    if result.steps or not isinstance(tree, Unary) or tree.op != "X" or tree.bound is not None:
        return False
    operand = result.part.with_tree(without_brackets(tree.operand))
    if isinstance(operand.tree, Unary) and operand.tree.op in ("X", "N"):
        return False
    formula = operand.formula()
    if formula is not None:
        return default_judge(formula) == "limit"
    # On a clock that varies, bounds have no formula.
    return not any(isinstance(part.tree, (Unary, BinaryExpr)) and part.tree.op in _AWAITING for part in operand.parts())


def _finding(rewriting: Rewriting, condition: str, steps: list[ScopedExpression]) -> RuleFinding:
    labels = tuple(
        Label(step.source, step.tree.span, f"so play must not end at the step of `{condition}`") for step in steps
    )
    step = steps[0]
    assert isinstance(step.tree, Unary)
    help_ = (
        f"if play may end there, write `{rewriting.text(steps)}`; "
        "if it must go on, allow it with the comment `// tltlc: allow TLT0449`"
    )
    word = step.source.slice(step.tree.op_span)
    return RuleFinding(f"this `{word}` also asks for a step after `{condition}`", labels, help_)


RULE = LintRule("TLT0449", "note", check)
