"""TLT0430: a clause that every trace satisfies."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import Label
from tltlc.logic.formula import not_
from tltlc.resolve.spec import Conjunct
from tltlc.tools.lint.atom_relations import relations
from tltlc.tools.lint.file_view import FileView, SpecView
from tltlc.tools.lint.removal_advice import removal_help
from tltlc.tools.lint.rule import LintRule, RuleFinding


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each clause of which it is proved that every trace satisfies it.

    A clause that is a conjunction has a finding for each such operand. A spec whose automaton accepts
    every trace has no findings, because the compiler warns about it.
    """
    for spec in view.specs:
        if spec.fspa.states[0].verdict == "satisfied":
            continue
        remaining = list(spec.spec.parts)
        for part in spec.spec.parts:
            if _is_always_met(part, spec):
                remaining = [candidate for candidate in remaining if candidate is not part]
                label = Label(part.source, part.span, "every trace satisfies this")
                yield RuleFinding(
                    "this clause asks nothing of the game",
                    (label,),
                    f"{removal_help(part, remaining, spec)}{_ALTERNATIVE}",
                )


def _is_always_met(part: Conjunct, spec: SpecView) -> bool:
    negated = replace(part, formula=not_(part.formula))
    return spec.decision((negated, *relations(spec, part.formula.atoms())), spec.spec)


_ALTERNATIVE: Final = ", or write what it should ask for: did you mean `and` instead of `or`, or the other way round?"

RULE = LintRule("TLT0430", "warning", check, supersedes=("TLT0429",))
