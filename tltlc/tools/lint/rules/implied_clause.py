"""TLT0413: a clause that the other clauses imply."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from tltlc.automaton.finite.contradiction import contradiction
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import Label
from tltlc.logic.formula import Formula, not_
from tltlc.resolve.spec import Conjunct, Spec
from tltlc.tools.lint.atom_relations import is_impossible, relations
from tltlc.tools.lint.file_view import FileView, SpecView
from tltlc.tools.lint.removal_advice import removal_help
from tltlc.tools.lint.rule import LintRule, RuleFinding
from tltlc.tools.lint.rules import recurrence

_MOST_PARTS = 24
"""Specs with more clauses are not checked, because each check builds automata from all clauses."""


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each clause that other clauses of its spec imply.

    The first label is on the implied clause. The next labels are on the clauses that imply it. These
    never include a clause that constrains only the last step (TLT0424), because it is usually a
    mistake.
    """
    last_step_labels = [finding.labels[0] for finding in recurrence.check(view)]
    for spec in view.specs:
        # Another rule reports duplicate clauses.
        first: dict[Formula, Conjunct] = {}
        for part in spec.spec.parts:
            first.setdefault(part.formula, part)
        parts = list(first.values())
        if 1 < len(parts) <= _MOST_PARTS and not is_impossible(spec):
            yield from _findings(spec, parts, [part for part in parts if not _contains_any(last_step_labels, part)])


def _contains_any(places: Sequence[Label], part: Conjunct) -> bool:
    return any(part.source == place.source and part.span.covers(place.span) for place in places)


def _findings(spec: SpecView, parts: Sequence[Conjunct], reasons: Sequence[Conjunct]) -> Iterator[RuleFinding]:
    possible_reasons, remaining = list(reasons), list(spec.spec.parts)
    # If two clauses imply each other, report the later one. A reported clause is no reason for others.
    for part in reversed(parts):
        candidates = [candidate for candidate in possible_reasons if candidate is not part]
        needed = _reasons(part, candidates, _relations(part, spec), spec)
        if needed:
            possible_reasons = candidates
            labels = (
                Label(part.source, part.span, "this adds nothing"),
                *(Label(reason.source, reason.span, "because of this") for reason in needed),
            )
            title = f"{'another clause already implies' if len(needed) == 1 else 'other clauses already imply'} this"
            remaining = [other for other in remaining if other.formula is not part.formula]
            yield RuleFinding(
                title, labels, f"{removal_help(part, remaining, spec)}, or write what else it should ask for"
            )


def _relations(part: Conjunct, spec: SpecView) -> list[Conjunct]:
    """Return those of the proved :func:`relations` of a spec that mention an atom of ``part``."""
    own = set(part.formula.atoms())
    return [
        relation
        for relation in relations(spec, spec.spec.formula.atoms())
        if own.intersection(relation.formula.atoms())
    ]


def _reasons(
    part: Conjunct, others: Sequence[Conjunct], proved: Sequence[Conjunct], spec: SpecView
) -> tuple[Conjunct, ...]:
    """Return a minimal subset of the clauses ``others`` that implies ``part``; () if they do not imply it.

    ``proved`` are the relations between atoms that the implication may use.
    """
    if not _share_atoms(part, others, proved, spec.spec):
        return ()
    negated = replace(part, formula=not_(part.formula))
    together = (*others, *proved, negated)
    if not spec.decision(together, spec.spec):
        return ()
    needed = contradiction(replace(spec.spec, parts=together), spec.decision)
    return tuple(other for other in needed if other in others)


def _share_atoms(part: Conjunct, others: Sequence[Conjunct], proved: Sequence[Conjunct], spec: Spec) -> bool:
    """Whether ``others`` mention an atom of ``part``, or an atom that is related to one of them.

    Atoms are related if a relation in ``proved`` or an exclusive group of the spec has both. If
    ``others`` mention no such atom, they cannot imply ``part``.
    """
    own = set(part.formula.atoms()).union(*(relation.formula.atoms() for relation in proved))
    for group in spec.exclusive:
        names = {spec.atoms[index].name for index in group}
        own |= names if own & names else set()
    return any(own.intersection(other.formula.atoms()) for other in others)


RULE = LintRule("TLT0413", "warning", check, supersedes=("TLT0443",))
