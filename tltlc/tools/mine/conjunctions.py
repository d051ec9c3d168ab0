"""Conjunctions of the best clauses: each clause rejects counterexamples that the others let pass."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Final

from tltlc.tools.mine.bits import Bits, Verdicts, count
from tltlc.tools.mine.candidates import ALIKE, length
from tltlc.tools.mine.clause import Clause, Conjunction, accepted_by, atoms_of
from tltlc.tools.mine.measure import figures
from tltlc.tools.mine.templates import BOUNDED

BEAM: Final = 60
"""Conjunctions of one length that are extended."""
MOST_CLAUSES: Final = 4
POOL: Final = 60
"""Clauses of each template of which they are made."""


def conjunctions(clauses: Sequence[Clause], bits: Bits, least: int, most_atoms: int) -> Iterator[list[Conjunction]]:
    """Conjunctions of two clauses and more, in portions, of which many are empty; each takes a short time.

    ``least`` and ``most_atoms`` are as for sequences.
    """
    pool = _pool(clauses)
    beam: list[tuple[Conjunction, Verdicts]] = [((each,), each.accepts) for each in pool]
    for _ in range(1, MOST_CLAUSES):
        found: dict[Conjunction, Verdicts] = {}
        for conjunction, accepts in beam[:BEAM]:
            room = most_atoms - atoms_of(conjunction)
            for each in pool:
                both = accepts & each.accepts
                if each.atoms > room or both == accepts or count(both & bits.traces) < least:
                    continue
                # The states that count one bound would be multiplied by those that count another.
                if each.kind == BOUNDED and each.kind in {clause.kind for clause in conjunction}:
                    continue
                longer = tuple(sorted((*conjunction, each), key=lambda clause: (clause.rank, clause.text)))
                if longer not in found and _all_needed(longer, both, bits):
                    found[longer] = both
            yield []
        beam = best(found.items(), bits)
        yield [conjunction for conjunction, _ in beam]


def _pool(clauses: Sequence[Clause]) -> list[Clause]:
    """The first clauses of each template, in their order: many good ones of one must not crowd out the others."""
    taken: dict[str, int] = {}
    found = []
    for each in clauses:
        taken[each.kind] = taken.get(each.kind, 0) + 1
        if taken[each.kind] <= POOL:
            found.append(each)
    return found


def best(candidates: Iterable[tuple[Conjunction, Verdicts]], bits: Bits) -> list[tuple[Conjunction, Verdicts]]:
    """The candidates by their score; of those that accept the same traces a few of the shortest."""

    def worth(item: tuple[Conjunction, Verdicts]) -> tuple[float, int, list[int], list[tuple[int, str]]]:
        conjunction, accepts = item
        size, clauses, ranks, texts = length(conjunction)
        return (-figures(bits, accepts).score(size), clauses, ranks, texts)

    shortest: dict[Verdicts, int] = {}
    alike: dict[Verdicts, int] = {}
    kept = []
    for conjunction, accepts in sorted(candidates, key=worth):
        size = atoms_of(conjunction)
        # In order of score those of the same traces come shortest first.
        if shortest.setdefault(accepts, size) == size:
            alike[accepts] = alike.get(accepts, 0) + 1
            if alike[accepts] <= ALIKE:
                kept.append((conjunction, accepts))
    return kept


def _all_needed(conjunction: Conjunction, accepts: Verdicts, bits: Bits) -> bool:
    """Whether no clause can go without a counterexample more being accepted."""
    others = (accepted_by((each for each in conjunction if each is not out), bits) for out in conjunction)
    return all(each & ~accepts & bits.counterexamples for each in others)
