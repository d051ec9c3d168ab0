"""TLT0433: `avoid a until b` and `reach a until b`, where a has no effect."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr
from tltlc.grammar.walk import operands
from tltlc.tools.lint.file_view import View, inner, operand
from tltlc.tools.lint.rule import LintRule, Remark


def check(view: View) -> Iterator[Remark]:
    """Yield a remark for each clause that amounts to its second formula.

    `a until b` holds at every step where b holds. In a chain of goals, only the last `until` gets a
    remark: an earlier one also says from when on the next goal counts.
    """
    for spec in view.specs:
        for clause, value in spec.clauses("reach", "avoid"):
            *earlier, last = operands(value.tree, "then")
            part = value.at(inner(last))
            if not isinstance(part.tree, BinaryExpr) or part.tree.op != "U":
                continue
            before, goal = value.at(part.tree.left), value.at(part.tree.right)
            label = Label(value.source, part.tree.span, f"this is `{clause.kind} {goal.text}` and no more")
            suggestion = f"say `require {operand(before)} until {operand(goal)}`"
            if clause.kind == "avoid":
                # `avoid` does not require its second formula to occur, hence `weak_until`.
                suggestion = f"say `require (not {operand(before)}) weak_until {operand(goal)}`"
            if earlier:
                suggestion = f"say `{operand(value.at(earlier[-1]))} and ({part.text})`, which counts from there on"
            yield Remark("the first half of this `until` has no say", (label,), suggestion)


RULE = LintRule("TLT0433", "warning", check)
