"""TLT0473: `a until eventually within 3 s b`, which ends up to 3 s before b, and `a until (b then c)`."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr, Unary
from tltlc.grammar.walk import operands, parts
from tltlc.tools.lint.file_view import FileView, ScopedExpression, operand_text, without_brackets
from tltlc.tools.lint.rule import LintRule, RuleFinding


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each `until` and `weak_until` whose right side is `eventually b` or `b then c`.

    The right side holds from the step on from which b comes in time, so the left side need not hold until b. In the
    same way, it need not hold from b to c.
    """
    for spec in view.specs:
        for root, part in ((formula, part) for formula in spec.formulas() for part in formula.parts()):
            if isinstance(part.tree, BinaryExpr) and part.tree.op in ("U", "W"):
                end = without_brackets(part.tree.right)
                if isinstance(end, Unary) and end.op == "F":
                    yield _finding(part, part.with_tree(part.tree.left), part.with_tree(end))
                elif isinstance(end, BinaryExpr) and end.op == "then":
                    is_whole = without_brackets(root.tree) is part.tree
                    yield _finding_of_goals(
                        part, part.with_tree(part.tree.left), part.with_tree(end), is_whole=is_whole
                    )


def _finding(until: ScopedExpression, first: ScopedExpression, end: ScopedExpression) -> RuleFinding:
    assert isinstance(until.tree, BinaryExpr) and isinstance(end.tree, Unary)
    goal, word = end.with_tree(end.tree.operand), until.source.slice(until.tree.op_span)
    label = Label(end.source, end.tree.span, f"this holds before `{goal.text}` does, and ends the `{word}`")
    meant = f"{operand_text(first)} {word} {operand_text(goal)}"
    if end.tree.bound is not None:
        meant = f"({meant}) and {end.text}"
    help_ = (
        f"if `{first.text}` must hold until `{goal.text}`, write `{meant}`; else allow this with the comment "
        "`// tltlc: allow TLT0473`"
    )
    return RuleFinding(f"this `{word}` may end before `{goal.text}`", (label,), help_)


def _finding_of_goals(
    until: ScopedExpression, first: ScopedExpression, end: ScopedExpression, *, is_whole: bool
) -> RuleFinding:
    """Return the finding; in an answer, a goal before the event of the rule must not count: no short text says that."""
    assert isinstance(until.tree, BinaryExpr)
    goals = [end.with_tree(goal) for goal in operands(end.tree, "then")]
    word, last = until.source.slice(until.tree.op_span), goals[-1]
    came = operand_text(goals[0])
    for goal in goals[1:]:
        came = f"({operand_text(goal)} and previously once {came})"
    label = Label(end.source, end.tree.span, f"this holds before `{last.text}` does, and ends the `{word}`")
    help_ = (
        f"if `{first.text}` must hold until `{last.text}`, write `{operand_text(first)} {word} {came}`; else allow "
        "this with the comment `// tltlc: allow TLT0473`"
    )
    is_timed = any(isinstance(part, BinaryExpr) and part.bound is not None for part in parts(end.tree))
    if is_timed or not is_whole:
        help_ = (
            f"say what holds at its end, such as `{operand_text(last)} and once {operand_text(goals[0])}`; else allow "
            "this with the comment `// tltlc: allow TLT0473`"
        )
    return RuleFinding(f"this `{word}` may end before `{last.text}`", (label,), help_)


RULE = LintRule("TLT0473", "warning", check)
