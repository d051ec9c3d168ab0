"""TLT0445: the same goal twice in a row, as in `reach a then a`, which two steps with a meet."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar import walk
from tltlc.grammar.tree import BinaryExpr, Unary
from tltlc.tools.lint.file_view import FileView, ScopedExpression, SpecView, operand_text
from tltlc.tools.lint.rule import LintRule, RuleFinding


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each goal of a `reach` clause that is the goal before it, and holds at one step.

    `begins a` after `a` is another goal.
    """
    for spec in view.specs:
        for _, value in spec.clauses("reach"):
            goals = [value.with_tree(tree) for tree in walk.operands(value.tree, "then")]
            for formula, group in groupby(goals, key=ScopedExpression.formula):
                same = [*group]
                if formula is not None and len(same) > 1 and _is_state(same[0]):
                    yield _finding(spec, value, same, is_whole=len(same) == len(goals))


def _is_state(goal: ScopedExpression) -> bool:
    """Whether a goal is about one step alone; `begins a` and `once a` are about steps before, too."""
    is_past = any(isinstance(part.tree, Unary) and part.tree.op != "not" for part in goal.parts())
    return goal.depends_on_one_step() and not is_past


def _finding(spec: SpecView, value: ScopedExpression, same: list[ScopedExpression], *, is_whole: bool) -> RuleFinding:
    """Return the finding for goals that are the same, of which a clause consists if ``is_whole``."""
    goal = same[0]
    thens = [part.tree for part in value.parts() if isinstance(part.tree, BinaryExpr) and part.tree.op == "then"]
    if is_whole and all(then.bound is None for then in thens):
        again, lasting = f"`reach times({goal.text}) >= {len(same)}`", f"`reach time_holding({goal.text}) >= 3 s`"
    else:
        again, lasting = f"`begins {operand_text(goal)}` in place of this goal", f"`time_holding({goal.text}) >= 3 s`"
    help_ = f"if it must begin again, write {again}"
    if spec.fspa.clock is not None:
        help_ += f"; if it must last, for example {lasting}"
    label = Label(value.source, same[1].tree.span, "the next step meets this if it still holds there")
    return RuleFinding(f"`{goal.text}` is the goal twice in a row", (label,), help_)


RULE = LintRule("TLT0445", "warning", check)
