"""Candidates: clauses of a spec, each with the traces that satisfy it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from tltlc.core.record import record
from tltlc.tools.mine.bits import Bits, Verdicts


@record
class Clause:
    """One clause: its ``text`` in the language, how many ``atoms`` it names, and the traces that it ``accepts``.

    ``asked`` are the traces in which the question arises at all: those in which the trigger of a response occurs.
    ``kind`` is the name of its template, ``rank`` the place of that in the order in which ties are broken.
    """

    kind: str
    rank: int
    text: str
    atoms: int
    accepts: Verdicts
    asked: Verdicts


Conjunction = tuple[Clause, ...]
"""Clauses of one spec, in the order in which it says them."""


def atoms_of(clauses: Sequence[Clause]) -> int:
    """How many atoms the clauses name together."""
    return sum(clause.atoms for clause in clauses)


def accepted_by(clauses: Iterable[Clause], bits: Bits) -> Verdicts:
    """The traces that satisfy all of the clauses."""
    found = bits.everything
    for each in clauses:
        found &= each.accepts
    return found
