"""TLT0445: the same event twice in a row, as in `reach a then a` and `avoid a then a`: two steps with a are enough."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar import walk
from tltlc.grammar.tree import BinaryExpr, CallExpr, TemporalInterval, Unary
from tltlc.tools.lint.file_view import FileView, ScopedExpression, SpecView, operand_text
from tltlc.tools.lint.rule import LintRule, RuleFinding


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each part of a chain that is the part before it, and holds at one step.

    Chains are the values of `reach` and `avoid` clauses. `begins a` after `a` is another part.
    """
    for spec in view.specs:
        for clause, value in spec.clauses("reach", "avoid"):
            chain = [value.with_tree(tree) for tree in walk.operands(value.tree, "then")]
            for formula, group in groupby(chain, key=ScopedExpression.formula):
                same = [*group]
                if formula is not None and len(same) > 1 and _is_state(same[0]):
                    is_whole = len(same) == len(chain)
                    if clause.kind == "reach":
                        yield _goal_finding(spec, value, same, is_whole=is_whole)
                    else:
                        yield _avoided_finding(value, same, is_whole=is_whole)


def _is_state(goal: ScopedExpression) -> bool:
    """Whether a goal is about one step alone; `begins a`, `once a` and `previous(x)` are about steps before, too."""
    trees = [part.tree for part in goal.parts()]
    is_past = any(isinstance(tree, Unary) and tree.op != "not" for tree in trees)
    is_change = any(isinstance(tree, CallExpr) and tree.name == "previous" for tree in trees)
    return goal.depends_on_one_step() and not (is_past or is_change)


def _goal_finding(
    spec: SpecView, value: ScopedExpression, same: list[ScopedExpression], *, is_whole: bool
) -> RuleFinding:
    """Return the finding for goals that are the same, of which a clause consists if ``is_whole``."""
    goal = same[0]
    if is_whole and not _bounds(value):
        again, lasting = f"`reach times({goal.text}) >= {len(same)}`", f"`reach time_holding({goal.text}) >= 3 s`"
    else:
        again, lasting = f"`begins {operand_text(goal)}` in place of this goal", f"`time_holding({goal.text}) >= 3 s`"
    help_ = f"if it must begin again, write {again}"
    if spec.fspa.clock is not None:
        help_ += f"; if it must last, for example {lasting}"
    label = Label(value.source, same[1].tree.span, "the next step meets this if it still holds there")
    return RuleFinding(f"`{goal.text}` is the goal twice in a row", (label,), help_)


def _avoided_finding(value: ScopedExpression, same: list[ScopedExpression], *, is_whole: bool) -> RuleFinding:
    """Return the finding for events that are the same, of which an `avoid` clause consists if ``is_whole``."""
    event, bounds = same[0], _bounds(value)
    begins = f"(begins {operand_text(event)})"
    again = f"`{begins}` in place of this"
    if is_whole and not bounds:
        again = f"`keep times({event.text}) <= {len(same) - 1}`"
    elif is_whole and len(same) == 2:
        time = bounds[0].high
        within = f"{value.with_tree(time).text}{'' if time.unit else ' steps'}"
        again = f"`avoid {begins} then within {within} {begins}`"
    label = Label(value.source, same[1].tree.span, "the next step counts as this if it still holds there")
    return RuleFinding(
        f"`{event.text}` is avoided twice in a row",
        (label,),
        f"if it may last, but must not begin again, write {again}; if each of its steps counts, allow this with the "
        "comment `// tltlc: allow TLT0445`",
    )


def _bounds(value: ScopedExpression) -> list[TemporalInterval]:
    """Return the bounds of a chain."""
    return [part.tree.bound for part in value.parts() if isinstance(part.tree, BinaryExpr) and part.tree.bound]


RULE = LintRule("TLT0445", "warning", check)
