"""TLT0425: a clause that occurs twice in a spec."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable, Iterator, Sequence
from typing import Final

from tltlc.core.source import Span
from tltlc.diagnostics.diagnostic import Fix
from tltlc.grammar.tree import Clause
from tltlc.logic.formula import Formula
from tltlc.resolve.spec import Conjunct
from tltlc.tools.lint.file_view import FileView
from tltlc.tools.lint.removal import removal_span
from tltlc.tools.lint.removal_advice import changes_judge
from tltlc.tools.lint.rule import LintRule, RuleFinding, removal_fix


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each clause, or conjunct of a clause, whose formula occurs earlier in the spec.

    Another rule, TLT0413, reports formulas that are equivalent but not equal.
    """
    for spec in view.specs:
        first: dict[Formula, Conjunct] = {}
        clauses = _clauses_of_one_part(spec.declaration.clauses, spec.spec.parts)
        remaining = list(spec.spec.parts)
        for part in spec.spec.parts:
            earlier = first.setdefault(part.formula, part)
            if earlier is not part:
                labels = (view.label(part.span, "occurs again here"), view.label(earlier.span, "first occurs here"))
                if part.unbounded != earlier.unbounded:
                    others = [candidate for candidate in remaining if candidate is not part]
                    if changes_judge(part, others, spec):
                        # The bound of the later part makes it a goal, for example `F[0,0] a` after `a`.
                        help_ = f"remove one of them and write `judge at {spec.fspa.judge}`"
                        yield RuleFinding(_TITLE, labels, help_)
                        continue
                    remaining = others
                yield RuleFinding(_TITLE, labels, "remove one of them", _fix(clauses.get(part.span), view))


def _fix(clause: Clause | None, view: FileView) -> Fix | None:
    """Return the fix that removes the clause, or None if ``clause`` is None."""
    if clause is None:
        return None
    return removal_fix("Remove one of them", (removal_span(view.source, clause.span, view.module.comments),))


def _clauses_of_one_part(clauses: Sequence[Clause], parts: Iterable[Conjunct]) -> dict[Span, Clause]:
    """Return the clauses that consist of a single conjunct, by the span of this conjunct."""
    starts = [clause.span.start for clause in clauses]
    covered: dict[int, list[Span]] = {}
    for part in parts:
        index = bisect_right(starts, part.span.start) - 1
        if index >= 0 and clauses[index].span.covers(part.span):
            covered.setdefault(index, []).append(part.span)
    return {spans[0]: clauses[index] for index, spans in covered.items() if len(spans) == 1}


_TITLE: Final = "this clause occurs twice"

RULE = LintRule("TLT0425", "warning", check)
