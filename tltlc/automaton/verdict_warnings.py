"""Warn about a spec that every trace satisfies, or that no trace satisfies."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import Diagnostic, Label

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Fspa
    from tltlc.logic.formula import Formula
    from tltlc.resolve.spec import Spec

_NO_ATOM: Final = "write a signal, a predicate or a comparison in place of `true` or `false`"
_MOST_LABELS: Final = 4
"""The most clauses of a contradiction that the warning marks in the source text."""


def verdict_warnings(spec: Spec, fspa: Fspa) -> tuple[Diagnostic, ...]:
    """Return one warning if every trace or no trace satisfies the spec, no warning otherwise."""
    verdict = fspa.states[0].verdict
    if verdict == "violated":
        return (_unsatisfiable_warning(spec),)
    if verdict == "satisfied":
        title, label = f"every trace satisfies `{spec.name}`", Label(spec.source, spec.name_span)
        if not spec.formula.atoms():
            suggestion = _NO_ATOM
        elif any(node.op in ("or", "implies") for node in spec.formula.walk()):
            suggestion = "it asks nothing of the game: did you mean `and` instead of an `or` or `implies`?"
        else:
            suggestion = "it asks nothing of the game: write a condition that can fail"
        return (Diagnostic("TLT0411", title, (label,), suggestion, severity="warning"),)
    return ()


def _recurs(formula: Formula) -> bool:
    """Whether the formula is ``G F p``, which a finite trace satisfies if ``p`` holds at its last sample."""
    return formula.op == "G" and formula.args[0].op == "F"


def _unsatisfiable_warning(spec: Spec) -> Diagnostic:
    """Return the warning that no trace satisfies a spec, with labels on the clauses that contradict each other."""
    from tltlc.automaton.finite.contradiction import contradiction, unsatisfiable

    is_infinite = spec.semantics == "infinite"
    decision = unsatisfiable
    if is_infinite:
        from tltlc.automaton.infinite import contradiction as over_infinite_traces

        decision = over_infinite_traces.unsatisfiable
    parts = contradiction(spec, decision)
    excluded = bool(spec.exclusive) and not decision(parts, replace(spec, exclusive=()))
    title = f"no trace satisfies `{spec.name}`"
    if len(parts) == 1:
        message, suggestion = "this cannot be met", "weaken it"
        (part,) = parts
        if not part.formula.atoms():
            suggestion = _NO_ATOM
        elif excluded:
            suggestion = "weaken it: atoms that are `exclusive` never hold together"
        elif part.formula.op == "G" and not is_infinite:
            once = replace(part, formula=part.formula.args[0])
            if not decision([once], spec):
                suggestion = "it must hold at every step, but nothing comes after the last step: did you mean `reach`?"
    else:
        message, suggestion = "together with the others", "these contradict each other: weaken one of them"
        if not is_infinite and any(_recurs(part.formula) for part in parts):
            suggestion += "; if play has no end and one of them comes again and again, write `semantics infinite`"
        elif excluded:
            suggestion += "; atoms that are `exclusive` never hold together"
    labels = tuple(Label(part.source, part.span, message) for part in parts[:_MOST_LABELS])
    return Diagnostic("TLT0410", title, labels or (Label(spec.source, spec.name_span),), suggestion, severity="warning")
