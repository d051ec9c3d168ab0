"""TLT0472: `keep a implies x > previous(x)`, which a first step with a breaks."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.past_words import FUNCTIONS
from tltlc.grammar.tree import BinaryExpr, CallExpr, Expr, Unary
from tltlc.grammar.walk import parts
from tltlc.tools.lint.asked_results import AskedResult, asked_results
from tltlc.tools.lint.file_view import FileView, ScopedExpression, operand_text, without_brackets
from tltlc.tools.lint.rule import LintRule, RuleFinding

_STRICT: Final = ("<", ">", "!=")
_LATER: Final = ("ends", "previously")
"""What no first step has."""


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each rule that asks for a change against the step before where its condition holds.

    At the first step, `previous(x)` is x. There is none if the condition says that there is a step before.
    """
    for spec in view.specs:
        for clause, value in spec.clauses("keep", "require"):
            rule = without_brackets(value.tree)
            for asked in asked_results(clause, value):
                if not asked.steps and _is_change(asked.part) and not _has_step_before(asked.condition.tree):
                    is_whole = (
                        isinstance(rule, BinaryExpr)
                        and without_brackets(rule.left) is asked.condition.tree
                        and without_brackets(rule.right) is without_brackets(asked.part.tree)
                    )
                    yield _finding(asked, "keep " if clause.kind == "keep" and is_whole else "")


def _is_change(answer: ScopedExpression) -> bool:
    """Whether an answer is `x > previous(x)`, or the same with `<` or `!=`."""
    tree = without_brackets(answer.tree)
    if not isinstance(tree, BinaryExpr) or tree.op not in _STRICT:
        return False
    sides = [without_brackets(tree.left), without_brackets(tree.right)]
    return any(
        isinstance(call, CallExpr)
        and call.name == "previous"
        and answer.with_tree(call.arguments[0].value).text == answer.with_tree(other).text
        for call, other in (sides, sides[::-1])
    )


def _has_step_before(condition: Expr) -> bool:
    return any(
        (isinstance(part, Unary) and part.op in _LATER) or (isinstance(part, CallExpr) and part.name in FUNCTIONS)
        for part in parts(condition)
    )


def _finding(asked: AskedResult, keyword: str) -> RuleFinding:
    """Return the finding for a rule; ``keyword`` is that of its clause, if the rule is all of it."""
    tree, answer = asked.condition.tree, asked.part.text
    is_chain = isinstance(tree, BinaryExpr) and tree.op == "and"
    condition = asked.condition.text if is_chain else operand_text(asked.condition)
    label = Label(asked.part.source, asked.part.tree.span, "false at the first step, where nothing has been before")
    help_ = (
        f"if play may begin with `{asked.condition.text}`, write "
        f"`{keyword}{condition} and previously true implies {answer}`"
    )
    if not keyword:
        help_ = f"if play may begin with `{asked.condition.text}`, add `and previously true` to that condition"
    help_ += "; if it cannot, allow this with the comment `// tltlc: allow TLT0472`"
    return RuleFinding(f"a first step with `{asked.condition.text}` breaks this rule", (label,), help_)


RULE = LintRule("TLT0472", "note", check)
