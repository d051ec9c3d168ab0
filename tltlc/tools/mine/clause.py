"""Clauses of a spec as candidates, each with the traces that satisfy it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from tltlc.core.record import record
from tltlc.tools.mine.bits import Bits, Verdicts


@record
class MinedClause:
    """One clause: its ``text``, its number of ``atoms``, and the traces that it ``accepts``.

    ``asked`` are the traces in which the clause is not vacuous, e.g. those in which the trigger of
    a response occurs. ``kind`` is the name of its template, and ``rank`` the place of the template
    in the order that breaks ties.
    """

    kind: str
    rank: int
    text: str
    atoms: int
    accepts: Verdicts
    asked: Verdicts


Conjunction = tuple[MinedClause, ...]
"""Clauses of one spec, in the order in which they are written."""


def atoms_of(clauses: Sequence[MinedClause]) -> int:
    """Return how many atoms the clauses name together."""
    return sum(clause.atoms for clause in clauses)


def accepted_by(clauses: Iterable[MinedClause], bits: Bits) -> Verdicts:
    """Return the traces that satisfy all of the clauses."""
    accepted = bits.everything
    for clause in clauses:
        accepted &= clause.accepts
    return accepted
