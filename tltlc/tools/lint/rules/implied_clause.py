"""TLT0413: a clause that the others imply."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from tltlc.automaton.finite.contradiction import contradiction
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import Label
from tltlc.logic.formula import Formula, not_
from tltlc.resolve.spec import Part, Spec
from tltlc.tools.lint.file_view import SpecView, View
from tltlc.tools.lint.relations import is_impossible, relations
from tltlc.tools.lint.removal_advice import leave_out
from tltlc.tools.lint.rule import Remark, Rule
from tltlc.tools.lint.rules import recurrence

_MOST_PARTS = 24
"""With more clauses than this they are not compared: each costs an automaton of the others."""


def check(view: View) -> Iterator[Remark]:
    """A remark for each clause that the others of its spec imply, and which of them do.

    What speaks of the last step alone was mostly not meant, so that nothing is concluded from it.
    """
    doubtful = [remark.labels[0] for remark in recurrence.check(view)]
    for spec in view.specs:
        # Of what stands twice another rule speaks.
        first: dict[Formula, Part] = {}
        for part in spec.spec.parts:
            first.setdefault(part.formula, part)
        parts = list(first.values())
        if 1 < len(parts) <= _MOST_PARTS and not is_impossible(spec):
            yield from _remarks(spec, parts, [part for part in parts if not _is_any_in(doubtful, part)])


def _is_any_in(places: Sequence[Label], part: Part) -> bool:
    return any(part.source == place.source and part.span.covers(place.span) for place in places)


def _remarks(spec: SpecView, parts: Sequence[Part], reasons: Sequence[Part]) -> Iterator[Remark]:
    left, remaining = list(reasons), list(spec.spec.parts)
    # The later of two that imply each other goes, and nothing is implied by what has gone.
    for part in reversed(parts):
        others = [other for other in left if other is not part]
        needed = _reasons(part, others, _known(part, spec), spec)
        if needed:
            left = others
            labels = (
                Label(part.source, part.span, "nothing is lost without this"),
                *(Label(other.source, other.span, "because of this") for other in needed),
            )
            title = f"{'another clause asks' if len(needed) == 1 else 'other clauses ask'} for this already"
            remaining = [each for each in remaining if each.formula is not part.formula]
            yield Remark(title, labels, f"{leave_out(part, remaining, spec)}, or say what more it should ask for")


def _known(part: Part, spec: SpecView) -> list[Part]:
    """What is known of the atoms of a part and of others, by the ranges of what they compare."""
    own = set(part.formula.atoms())
    return [each for each in relations(spec, spec.spec.formula.atoms()) if own.intersection(each.formula.atoms())]


def _reasons(part: Part, others: Sequence[Part], known: Sequence[Part], spec: SpecView) -> tuple[Part, ...]:
    """Of the other parts some that imply a part together, none of which could be left out; none where they do not."""
    if not _share_atoms(part, others, known, spec.spec):
        return ()
    negated = replace(part, formula=not_(part.formula))
    together = (*others, *known, negated)
    if not spec.decision(together, spec.spec):
        return ()
    needed = contradiction(replace(spec.spec, parts=together), spec.decision)
    return tuple(each for each in needed if each in others)


def _share_atoms(part: Part, others: Sequence[Part], known: Sequence[Part], spec: Spec) -> bool:
    """Whether the others speak of an atom of the part, or of one that excludes it: if not, they say nothing of it."""
    own = set(part.formula.atoms()).union(*(each.formula.atoms() for each in known))
    for group in spec.exclusive:
        names = {spec.atoms[index].name for index in group}
        own |= names if own & names else set()
    return any(own.intersection(other.formula.atoms()) for other in others)


RULE = Rule("TLT0413", "warning", check)
