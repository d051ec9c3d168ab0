"""TLT0425: a clause that stands twice in a spec."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.diagnostics.diagnostic import Fix
from tltlc.lint.removal import without
from tltlc.lint.rule import Remark, Rule, removal
from tltlc.lint.view import SpecView, View
from tltlc.logic.formula import Formula
from tltlc.resolve.spec import Part


def check(view: View) -> Iterator[Remark]:
    """A remark for each clause, or part of one, that says the same as an earlier one in the same form."""
    for spec in view.specs:
        first: dict[Formula, Part] = {}
        for part in spec.spec.parts:
            earlier = first.setdefault(part.formula, part)
            if earlier is not part:
                labels = (view.label(part.span, "this again"), view.label(earlier.span, "said here"))
                yield Remark("this clause stands here twice", labels, "remove one of them", _fix(part, spec, view))


def _fix(part: Part, spec: SpecView, view: View) -> Fix | None:
    """Without the clause, where the part is all that it says."""
    for clause in spec.declaration.clauses:
        alone = [each for each in spec.spec.parts if clause.span.covers(each.span)]
        if alone == [part]:
            return removal("Remove one of them", (without(view.source, clause.span, view.module.comments),))
    return None


RULE = Rule("TLT0425", "warning", check)
