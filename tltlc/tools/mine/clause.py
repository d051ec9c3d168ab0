"""Candidate clauses, each with the traces that satisfy it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from tltlc.core.record import record
from tltlc.tools.mine.bits import Bits, TraceMask


@record
class MinedClause:
    """A clause: its ``text``, its number of ``atoms``, and the traces that it ``accepts``.

    In ``atoms``, a bound counts as one atom, and so does each `and` or `or` in a step of `reach`.
    ``not_vacuous`` has the traces that put the clause to the test: for `keep a implies b`, those in
    which a occurs. ``kind`` is the name of the clause's template, and ``rank`` is the index of the
    template in :data:`~tltlc.tools.mine.templates.KINDS`, which breaks ties.
    """

    kind: str
    rank: int
    text: str
    atoms: int
    accepts: TraceMask
    not_vacuous: TraceMask


Conjunction = tuple[MinedClause, ...]
"""Clauses of one spec, in the order in which they are written."""


def count_atoms(clauses: Sequence[MinedClause]) -> int:
    """Return the sum of ``atoms`` over the clauses: the length of a conjunction."""
    return sum(clause.atoms for clause in clauses)


def accepted_traces(clauses: Iterable[MinedClause], bits: Bits) -> TraceMask:
    """Return the traces that satisfy all of the clauses."""
    accepted = bits.all_traces
    for clause in clauses:
        accepted &= clause.accepts
    return accepted
