"""TLT0428: a limit that ends the episode before the goal can be reached."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.grammar import walk
from tltlc.grammar.tree import BinaryExpr, CallExpr, NumberExpr
from tltlc.resolve.constants import samples
from tltlc.resolve.units import time_units
from tltlc.tools.lint.file_view import FileView, SpecView, without_brackets
from tltlc.tools.lint.goals import conjuncts
from tltlc.tools.lint.rule import LintRule, RuleFinding


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each spec whose goal needs more steps than its limit allows.

    A goal may need them because of the distance in the automaton, or because it asks for a long
    ``time_holding``.
    """
    for spec in view.specs:
        limit = spec.spec.limit_steps
        if limit is None:
            continue
        least = max([spec.fspa.states[0].distance or 0, *_times(spec)])
        if least > limit:
            clause = next(clause for clause in spec.declaration.clauses if clause.kind == "limit")
            label = view.label(clause.span, f"the goal takes at least {least} steps, and this is {limit}")
            title = f"`{spec.spec.name}` cannot be met within its limit"
            yield RuleFinding(title, (label,), f"allow more: at least `limit {least} steps`")


def _times(spec: SpecView) -> Iterator[int]:
    """Yield how many steps it takes until the goals of `reach` hold that ask for a `time_holding`."""
    if spec.spec.clock_s is None or spec.spec.semantics == "infinite":
        return
    for _, value in spec.clauses("reach"):
        for goal in walk.operands(value.tree, "then"):
            for part in conjuncts(value.with_tree(goal)):
                tree = part.tree
                if not isinstance(tree, BinaryExpr) or tree.op not in (">", ">="):
                    continue
                left, right = without_brackets(tree.left), without_brackets(tree.right)
                is_timer = isinstance(left, CallExpr) and left.name == "time_holding"
                if is_timer and isinstance(right, NumberExpr) and right.unit in time_units():
                    # The time is 0 s at the first step.
                    yield samples(right, part.env) + 1


RULE = LintRule("TLT0428", "warning", check)
