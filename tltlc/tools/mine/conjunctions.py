"""Conjunctions of the best clauses: each clause rejects counterexamples that the others accept."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Final

from tltlc.tools.mine.bits import Bits, Verdicts, count
from tltlc.tools.mine.candidates import ALIKE, length
from tltlc.tools.mine.clause import Conjunction, MinedClause, accepted_by, atoms_of
from tltlc.tools.mine.measure import figures
from tltlc.tools.mine.templates import BOUNDED

BEAM: Final = 60
"""The most conjunctions of one length that are extended."""
MOST_CLAUSES: Final = 4
POOL: Final = 60
"""The most clauses of each template that conjunctions are built from."""


def conjunctions(
    clauses: Sequence[MinedClause], bits: Bits, least: int, most_atoms: int
) -> Iterator[list[Conjunction]]:
    """Yield conjunctions of two or more clauses, in portions; each portion takes a short time.

    Many portions are empty. ``least`` and ``most_atoms`` are as for sequences.
    """
    pool = _pool(clauses)
    beam: list[tuple[Conjunction, Verdicts]] = [((addition,), addition.accepts) for addition in pool]
    for _ in range(1, MOST_CLAUSES):
        accepted_by_longer: dict[Conjunction, Verdicts] = {}
        for conjunction, accepts in beam[:BEAM]:
            room = most_atoms - atoms_of(conjunction)
            for addition in pool:
                both = accepts & addition.accepts
                if addition.atoms > room or both == accepts or count(both & bits.traces) < least:
                    continue
                # Two bounds would multiply the numbers of states that count them.
                if addition.kind == BOUNDED and addition.kind in {clause.kind for clause in conjunction}:
                    continue
                longer = tuple(sorted((*conjunction, addition), key=lambda clause: (clause.rank, clause.text)))
                if longer not in accepted_by_longer and _all_needed(longer, both, bits):
                    accepted_by_longer[longer] = both
            yield []
        beam = best(accepted_by_longer.items(), bits)
        yield [conjunction for conjunction, _ in beam]


def _pool(clauses: Sequence[MinedClause]) -> list[MinedClause]:
    """Return the first clauses of each template, in order.

    The limit per template keeps many good clauses of one template from crowding out the others.
    """
    taken: dict[str, int] = {}
    pool = []
    for clause in clauses:
        taken[clause.kind] = taken.get(clause.kind, 0) + 1
        if taken[clause.kind] <= POOL:
            pool.append(clause)
    return pool


def best(candidates: Iterable[tuple[Conjunction, Verdicts]], bits: Bits) -> list[tuple[Conjunction, Verdicts]]:
    """Return the candidates by score, with a few of the shortest for each set of accepted traces."""

    def worth(item: tuple[Conjunction, Verdicts]) -> tuple[float, int, list[int], list[tuple[int, str]]]:
        conjunction, accepts = item
        size, clauses, ranks, texts = length(conjunction)
        return (-figures(bits, accepts).score(size), clauses, ranks, texts)

    shortest: dict[Verdicts, int] = {}
    alike: dict[Verdicts, int] = {}
    chosen = []
    for conjunction, accepts in sorted(candidates, key=worth):
        size = atoms_of(conjunction)
        # Among candidates with the same traces, the shortest have the best score and come first.
        if shortest.setdefault(accepts, size) == size:
            alike[accepts] = alike.get(accepts, 0) + 1
            if alike[accepts] <= ALIKE:
                chosen.append((conjunction, accepts))
    return chosen


def _all_needed(conjunction: Conjunction, accepts: Verdicts, bits: Bits) -> bool:
    """Whether dropping any clause would accept a further counterexample."""
    without_one = (
        accepted_by((clause for clause in conjunction if clause is not dropped), bits) for dropped in conjunction
    )
    return all(accepted & ~accepts & bits.counterexamples for accepted in without_one)
