"""TLT0431: clauses that contradict each other by what their atoms say of signals."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltlc.automaton.finite.contradiction import contradiction
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import Label
from tltlc.logic.text.phrases import phrase
from tltlc.tools.lint.file_view import SpecView, View
from tltlc.tools.lint.relations import is_impossible, relations
from tltlc.tools.lint.rule import Remark, Rule

_MOST_LABELS: Final = 4


def check(view: View) -> Iterator[Remark]:
    """A remark for each spec that no trace satisfies, where the compiler, to which atoms are atoms, does not see it."""
    for spec in view.specs:
        if spec.fspa.states[0].verdict != "violated" and is_impossible(spec):
            yield _remark(spec)


def _remark(spec: SpecView) -> Remark:
    known = relations(spec, [atom.name for atom in spec.fspa.atoms])
    needed = contradiction(replace(spec.spec, parts=(*known, *spec.spec.parts)), spec.decision)
    clauses = [part for part in needed if part not in known]
    together = "this cannot be met" if len(clauses) == 1 else "together with the others"
    labels = tuple(Label(part.source, part.span, together) for part in clauses[:_MOST_LABELS])
    never = next(part for part in needed if part in known).formula.args[0].args[0]
    title = f"no trace satisfies `{spec.spec.name}`, by the values that its signals can have"
    way_out = f"`{phrase(never)}` is never true: check the numbers, and the direction of each comparison"
    return Remark(title, labels, way_out)


RULE = Rule("TLT0431", "warning", check)
