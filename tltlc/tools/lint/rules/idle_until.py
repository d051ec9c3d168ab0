"""TLT0433: `avoid a until b` and `reach a until b`, where a has no effect."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr
from tltlc.grammar.walk import operands
from tltlc.tools.lint.file_view import FileView, operand_text, without_brackets
from tltlc.tools.lint.rule import LintRule, RuleFinding


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each `until` in a `reach` or `avoid` clause.

    `a until b` holds at every step where b holds, so the clause means the same with b alone. In a
    chain such as `reach (a until b) then (c until d)`, only the last `until` gets a finding: an
    earlier `until` also determines from which step on the next goal counts.
    """
    for spec in view.specs:
        for clause, value in spec.clauses("reach", "avoid"):
            *earlier, last = operands(value.tree, "then")
            part = value.with_tree(without_brackets(last))
            if not isinstance(part.tree, BinaryExpr) or part.tree.op != "U":
                continue
            before, goal = value.with_tree(part.tree.left), value.with_tree(part.tree.right)
            rest = goal.text if earlier else f"{clause.kind} {goal.text}"
            label = Label(value.source, part.tree.span, f"this means only `{rest}`")
            help_ = f"write `require {operand_text(before)} until {operand_text(goal)}`"
            if clause.kind == "avoid":
                # `avoid` does not require its second formula to occur, hence `weak_until`.
                help_ = f"write `require (not {operand_text(before)}) weak_until {operand_text(goal)}`"
            if earlier:
                previous = operand_text(value.with_tree(earlier[-1]))
                help_ = f"write `{previous} and ({part.text})`, which counts from that step on"
            yield RuleFinding("the first half of this `until` has no effect", (label,), help_)


RULE = LintRule("TLT0433", "warning", check)
