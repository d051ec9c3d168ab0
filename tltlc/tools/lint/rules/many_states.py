"""TLT0423: an automaton that is much larger than the spec suggests."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltlc.automaton.finite.blowup import bound_advice
from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.walk import parts
from tltlc.resolve.specs import MOST_UNFOLDED
from tltlc.tools.lint.file_view import FileView, SpecView
from tltlc.tools.lint.rule import LintRule, RuleFinding

_FEW: Final = 100
_PER_PART: Final = 10
"""There is no finding for up to ``_FEW`` states, or for up to this many states per part of the spec.

The parts of a spec are its operators, names and numbers.
"""

_MOST_LABELS: Final = 4


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each spec whose automaton has many more states than the spec has parts."""
    for spec in view.specs:
        part_count = sum(1 for formula in spec.formulas() for _ in parts(formula.tree))
        states = len(spec.fspa.states)
        if states > max(_FEW, _PER_PART * part_count):
            yield _finding(spec, states)


def _finding(spec: SpecView, states: int) -> RuleFinding:
    bounds = [bound for part in spec.spec.parts for bound in part.bounds]
    title = f"the automaton of `{spec.spec.name}` has {states} states"
    if bounds:
        worst = max(bounds, key=lambda bound: bound.samples)
        label = Label(
            worst.source, worst.span, f"this bound counts {worst.samples} samples, and each needs at least one state"
        )
        return RuleFinding(
            title,
            (label,),
            bound_advice(worst) if worst.samples > MOST_UNFOLDED else "shorten it, or choose a slower `clock`",
        )
    first, *rest = (Label(part.source, part.span) for part in spec.spec.parts[:_MOST_LABELS])
    message = "the states of its parts multiply" if rest else "this has to remember a lot"
    help_ = "split the spec, give an order with `then`, or declare atoms that never hold together `exclusive`"
    return RuleFinding(title, (Label(first.source, first.span, message), *rest), help_)


RULE = LintRule("TLT0423", "note", check, lint_only=True)
