"""TLT0420: a spec that has no goal, and does not say that it is to be judged at its limit."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.logic.formula import Formula
from tltlc.tools.lint.file_view import SpecView, View
from tltlc.tools.lint.rule import Remark, Rule


def check(view: View) -> Iterator[Remark]:
    """A remark for each spec that is judged at its limit without a clause that says so."""
    for spec in view.specs:
        # One without a limit has a remark of its own, and one that every trace satisfies, or none, a warning.
        has_own = spec.is_settled or spec.spec.limit_steps is None
        if _is_judged_at_limit(spec) and spec.spec.judge is None and not has_own:
            label = spec.name_label("it rewards lasting: progress is the share of its limit that has passed")
            way_out = "add a goal with `reach`, or say that this is meant: `judge at limit`"
            yield Remark(f"`{spec.spec.name}` has no goal, so it is judged at its limit", (label,), way_out)


def _is_judged_at_limit(spec: SpecView) -> bool:
    # Over infinite traces a spec with a goal is judged so as well, where the goal does not settle all.
    endless = spec.spec.semantics == "infinite"
    lasts = not endless or (spec.fspa.states[0].distance == 0 and not _recurs(spec.spec.formula))
    return spec.fspa.judge == "limit" and lasts


def _recurs(formula: Formula) -> bool:
    """Whether something is to come again and again: a goal that is never done."""
    return any(part.op == "G" and part.args[0].op == "F" for part in formula.walk())


RULE = Rule("TLT0420", "note", check)
