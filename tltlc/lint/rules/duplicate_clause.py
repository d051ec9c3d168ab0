"""TLT0425: a clause that stands twice in a spec."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltlc.diagnostics.diagnostic import Fix
from tltlc.lint.leaving_out import changes_judge
from tltlc.lint.removal import without
from tltlc.lint.rule import Remark, Rule, removal
from tltlc.lint.view import SpecView, View
from tltlc.logic.formula import Formula
from tltlc.resolve.spec import Part


def check(view: View) -> Iterator[Remark]:
    """A remark for each clause, or part of one, that says the same as an earlier one in the same form."""
    for spec in view.specs:
        first: dict[Formula, Part] = {}
        remaining = list(spec.spec.parts)
        for part in spec.spec.parts:
            earlier = first.setdefault(part.formula, part)
            if earlier is not part:
                labels = (view.label(part.span, "this again"), view.label(earlier.span, "said here"))
                others = [each for each in remaining if each is not part]
                if changes_judge(others, spec):
                    # The bound of the later one, as in `F[0,0] a` behind `a`, makes it a goal.
                    way_out = f"remove one of them and say `judge at {spec.fspa.judge}`"
                    yield Remark(_TITLE, labels, way_out)
                else:
                    remaining = others
                    yield Remark(_TITLE, labels, "remove one of them", _fix(part, spec, view))


def _fix(part: Part, spec: SpecView, view: View) -> Fix | None:
    """Without the clause, where the part is all that it says."""
    for clause in spec.declaration.clauses:
        alone = [each for each in spec.spec.parts if clause.span.covers(each.span)]
        if alone == [part]:
            return removal("Remove one of them", (without(view.source, clause.span, view.module.comments),))
    return None


_TITLE: Final = "this clause stands here twice"

RULE = Rule("TLT0425", "warning", check)
