"""TLT0472: `keep a implies x > previous(x)` and its like, which a first step with a breaks."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from operator import eq, ge, gt, le, lt, ne
from typing import Final

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.past_words import FUNCTIONS
from tltlc.grammar.tree import BinaryExpr, CallExpr, Expr, IsExpr, NumberExpr, Unary
from tltlc.grammar.walk import parts
from tltlc.tools.lint.asked_results import AskedResult, asked_results
from tltlc.tools.lint.file_view import FileView, ScopedExpression, operand_text, without_brackets
from tltlc.tools.lint.rule import LintRule, RuleFinding

_COMPARED: Final[Mapping[str, Callable[[float, float], bool]]] = {
    "<": lt,
    ">": gt,
    "<=": le,
    ">=": ge,
    "==": eq,
    "!=": ne,
}
_LATER: Final = ("ends", "previously", "once", "since")
"""What says what has been, or that there is a step before."""


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each rule that asks for a change against the step before where its condition holds.

    At the first step, `previous(x)` is x. There is none if the condition says that there is a step before.
    """
    for spec in view.specs:
        for clause, value in spec.clauses("keep", "require"):
            for asked in asked_results(clause, value):
                condition = asked.condition.tree
                if not asked.steps and _is_change(asked.part, condition) and not has_step_before(condition):
                    yield _finding(asked, "keep " if asked.is_all_of(clause, value) else "")


def _is_change(answer: ScopedExpression, condition: Expr) -> bool:
    """Whether an answer is false at the first step: `x > previous(x)`, `x == previous(x) - 1`, or a turn of an enum."""
    tree = without_brackets(answer.tree)
    if isinstance(tree, Unary) and tree.op == "previously":
        before = without_brackets(tree.operand)
        return isinstance(before, IsExpr) and any(
            isinstance(turned, IsExpr) and same_text(answer, turned.operand, before.operand)
            for part in parts(condition)
            if isinstance(part, Unary) and part.op == "begins"
            for turned in [without_brackets(part.operand)]
        )
    if not isinstance(tree, BinaryExpr) or tree.op not in _COMPARED:
        return False
    sides = [without_brackets(tree.left), without_brackets(tree.right)]
    for one, other in (sides, sides[::-1]):
        call, step = moved(other)
        if not isinstance(call, CallExpr) or call.name != "previous":
            continue
        if same_text(answer, call.arguments[0].value, one):
            return not _COMPARED[tree.op](*((0.0, step) if one is sides[0] else (step, 0.0)))
    return False


def moved(side: Expr) -> tuple[Expr, float]:
    """Return y and the number of `y + 2`, `y - 2` or `y`."""
    if not isinstance(side, BinaryExpr) or side.op not in ("+", "-"):
        return side, 0.0
    step = without_brackets(side.right)
    if not isinstance(step, NumberExpr):
        return side, 0.0
    return without_brackets(side.left), step.value if side.op == "+" else -step.value


def same_text(part: ScopedExpression, one: Expr, other: Expr) -> bool:
    """Whether two parts of an expression have the same text, apart from brackets around them."""
    return part.with_tree(one).text == part.with_tree(other).text


def has_step_before(condition: Expr) -> bool:
    """Whether a condition says that there is a step before, or is about what has been."""
    return any(
        (isinstance(part, (Unary, BinaryExpr)) and part.op in _LATER)
        or (isinstance(part, CallExpr) and part.name in FUNCTIONS)
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
