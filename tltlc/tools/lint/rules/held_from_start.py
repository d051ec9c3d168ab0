"""TLT0477: `keep mode is clean implies time_holding(calm) >= 2 s`, which the first 2 s of play cannot keep."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr, CallExpr, IsExpr, NumberExpr
from tltlc.grammar.walk import conjuncts
from tltlc.tools.lint.asked_results import AskedResult, asked_results
from tltlc.tools.lint.file_view import FileView, operand_text, without_brackets
from tltlc.tools.lint.rule import LintRule, RuleFinding
from tltlc.tools.lint.rules.first_change import has_step_before


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each rule that a condition has held for a time while an enum has a value.

    At the first step, the time is 0. There is none if the condition of the rule says what has been.
    """
    for spec in view.specs:
        for clause, value in spec.clauses("keep", "require"):
            for asked in asked_results(clause, value):
                tests = conjuncts(asked.condition.tree)
                is_state = any(isinstance(without_brackets(tree), IsExpr) for tree in tests)
                if is_state and not asked.steps and not has_step_before(asked.condition.tree):
                    yield from _findings(asked)


def _findings(asked: AskedResult) -> Iterator[RuleFinding]:
    tree = without_brackets(asked.part.tree)
    if not isinstance(tree, BinaryExpr) or tree.op != ">=" or not isinstance(tree.right, NumberExpr):
        return
    timer = without_brackets(tree.left)
    if not isinstance(timer, CallExpr) or timer.name != "time_holding" or timer.arguments[1:] or tree.right.value <= 0:
        return
    held = operand_text(asked.part.with_tree(timer.arguments[0].value))
    time = asked.part.with_tree(tree.right).text
    label = Label(asked.part.source, tree.span, f"false in the first {time} of play, whatever holds there")
    help_ = (
        f"if it is enough that `{held}` has held since the first step, write `historically for {time} {held}`; "
        "else allow this with the comment `// tltlc: allow TLT0477`"
    )
    yield RuleFinding(f"`{asked.condition.text}` breaks this in the first {time}", (label,), help_)


RULE = LintRule("TLT0477", "note", check)
