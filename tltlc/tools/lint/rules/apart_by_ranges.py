"""TLT0431: clauses that contradict each other because of the ranges of signals."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltlc.automaton.finite.contradiction import contradiction
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import Label
from tltlc.logic.text.phrases import phrase
from tltlc.tools.lint.atom_relations import is_impossible, relations
from tltlc.tools.lint.file_view import FileView, SpecView
from tltlc.tools.lint.rule import LintRule, RuleFinding

_MOST_LABELS: Final = 4


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each spec that is unsatisfiable because of the ranges of its signals.

    The compiler treats atoms as independent, so it does not report such a spec.
    """
    for spec in view.specs:
        if spec.fspa.states[0].verdict != "violated" and is_impossible(spec):
            yield _finding(spec)


def _finding(spec: SpecView) -> RuleFinding:
    proved = relations(spec, [atom.name for atom in spec.fspa.atoms])
    needed = contradiction(replace(spec.spec, parts=(*proved, *spec.spec.parts)), spec.decision)
    clauses = [part for part in needed if part not in proved]
    together = "this cannot be met" if len(clauses) == 1 else "together with the others"
    labels = tuple(Label(part.source, part.span, together) for part in clauses[:_MOST_LABELS])
    excluded = next(part for part in needed if part in proved).formula.args[0].args[0]
    title = f"no trace satisfies `{spec.spec.name}`, because of the values that its signals can have"
    help_ = f"`{phrase(excluded)}` is never true: check the numbers, and the direction of each comparison"
    return RuleFinding(title, labels, help_)


RULE = LintRule("TLT0431", "warning", check)
