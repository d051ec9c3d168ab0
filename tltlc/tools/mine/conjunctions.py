"""Build conjunctions of the best clauses.

Each clause of a conjunction rejects a counterexample that its other clauses accept.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Final

from tltlc.tools.mine.bits import Bits, TraceMask, count
from tltlc.tools.mine.candidates import ALIKE, sort_key
from tltlc.tools.mine.clause import Conjunction, MinedClause, accepted_traces, count_atoms
from tltlc.tools.mine.score import figures
from tltlc.tools.mine.templates import TIMED

BEAM: Final = 60
"""The most conjunctions of one length that are extended."""
MOST_CLAUSES: Final = 4
POOL: Final = 60
"""The most clauses of each template that conjunctions are built from."""


def conjunctions(
    clauses: Sequence[MinedClause], bits: Bits, least: int, most_atoms: int
) -> Iterator[list[Conjunction]]:
    """Yield conjunctions of two or more clauses, in portions; the search is a beam search.

    At least ``least`` traces satisfy each conjunction, and it has at most ``most_atoms`` atoms. Many
    portions are empty: they only give the caller a chance to stop the search.
    """
    pool = _pool(clauses)
    beam: list[tuple[Conjunction, TraceMask]] = [((addition,), addition.accepts) for addition in pool]
    for _ in range(1, MOST_CLAUSES):
        accepted_by_longer: dict[Conjunction, TraceMask] = {}
        for conjunction, accepts in beam[:BEAM]:
            room = most_atoms - count_atoms(conjunction)
            for addition in pool:
                both = accepts & addition.accepts
                if addition.atoms > room or both == accepts or count(both & bits.traces) < least:
                    continue
                # One clause of each kind of count or time is enough to read.
                if addition.kind in TIMED and addition.kind in {clause.kind for clause in conjunction}:
                    continue
                longer = tuple(sorted((*conjunction, addition), key=lambda clause: (clause.rank, clause.text)))
                if longer not in accepted_by_longer and _all_needed(longer, both, bits):
                    accepted_by_longer[longer] = both
            yield []
        beam = best_candidates(accepted_by_longer.items(), bits)
        yield [conjunction for conjunction, _ in beam]


def _pool(clauses: Sequence[MinedClause]) -> list[MinedClause]:
    """Return the first ``POOL`` clauses of each template, in order.

    With one limit for all templates together, many good clauses of one template would leave no room
    for the others.
    """
    counts: dict[str, int] = {}
    pool = []
    for clause in clauses:
        counts[clause.kind] = counts.get(clause.kind, 0) + 1
        if counts[clause.kind] <= POOL:
            pool.append(clause)
    return pool


def best_candidates(
    candidates: Iterable[tuple[Conjunction, TraceMask]], bits: Bits
) -> list[tuple[Conjunction, TraceMask]]:
    """Sort candidates by score, the highest first, and leave out superfluous ones.

    A candidate is a conjunction with the set of traces that it accepts. Of all candidates that
    accept the same traces, at most ``ALIKE`` of the shortest remain.
    """

    def score_key(item: tuple[Conjunction, TraceMask]) -> tuple[float, int, list[int], list[tuple[int, str]]]:
        conjunction, accepts = item
        size, clauses, ranks, texts = sort_key(conjunction)
        return (-figures(bits, accepts).score(size), clauses, ranks, texts)

    shortest: dict[TraceMask, int] = {}
    alike: dict[TraceMask, int] = {}
    chosen = []
    for conjunction, accepts in sorted(candidates, key=score_key):
        size = count_atoms(conjunction)
        # Among candidates with the same traces, the shortest have the best score and come first.
        if shortest.setdefault(accepts, size) == size:
            alike[accepts] = alike.get(accepts, 0) + 1
            if alike[accepts] <= ALIKE:
                chosen.append((conjunction, accepts))
    return chosen


def _all_needed(conjunction: Conjunction, accepts: TraceMask, bits: Bits) -> bool:
    """Whether each clause rejects a counterexample that the other clauses of the conjunction accept.

    ``accepts`` is the set of traces that the whole conjunction accepts.
    """
    accepted_by_rest = (
        accepted_traces((clause for clause in conjunction if clause is not dropped), bits) for dropped in conjunction
    )
    return all(accepted & ~accepts & bits.counterexamples for accepted in accepted_by_rest)
