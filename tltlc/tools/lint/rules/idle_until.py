"""TLT0433: `avoid a until b` and `reach a until b`, where a has no say."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import Binary
from tltlc.grammar.walk import operands
from tltlc.tools.lint.file_view import View, inner, operand
from tltlc.tools.lint.rule import Remark, Rule


def check(view: View) -> Iterator[Remark]:
    """A remark for each clause that comes to its second formula, since `a until b` holds wherever b does.

    Of a chain of goals it is the last: one before it also says since when the next is waited for.
    """
    for spec in view.specs:
        for clause, value in spec.clauses("reach", "avoid"):
            *others, last = operands(value.tree, "then")
            part = value.at(inner(last))
            if not isinstance(part.tree, Binary) or part.tree.op != "U":
                continue
            before, goal = value.at(part.tree.left), value.at(part.tree.right)
            label = Label(value.source, part.tree.span, f"this is `{clause.kind} {goal.text}` and no more")
            way_out = f"say `require {operand(before)} until {operand(goal)}`"
            if clause.kind == "avoid":
                # What is only forbidden need not come.
                way_out = f"say `require (not {operand(before)}) weak_until {operand(goal)}`"
            if others:
                way_out = f"say `{operand(value.at(others[-1]))} and ({part.text})`, which counts from there on"
            yield Remark("the first half of this `until` has no say", (label,), way_out)


RULE = Rule("TLT0433", "warning", check)
