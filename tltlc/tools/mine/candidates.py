"""The candidates that a search keeps: a few of the shortest for each set of accepted traces."""

from __future__ import annotations

from bisect import insort
from collections.abc import Iterator
from typing import Final

from tltlc.io.limits import WORK
from tltlc.tools.mine.bits import Bits, TraceMask
from tltlc.tools.mine.clause import Conjunction, count_atoms
from tltlc.tools.mine.score import figures

ALIKE: Final = 3
"""The most candidates of one length that are kept for one set of accepted traces."""
_MOST: Final = WORK["mined candidates"]


class Candidates:
    """A collection of conjunctions of clauses, each with the set of traces that it accepts.

    It keeps only the conjunctions that :func:`~tltlc.tools.mine.conjunctions.best_candidates` would
    choose: for each set of accepted traces, a few of the shortest. If there are too many of these
    sets, it keeps only the sets whose conjunctions have the best scores; then ``is_cut`` is true.
    """

    def __init__(self, bits: Bits) -> None:
        self._bits = bits
        self._groups: dict[TraceMask, list[Conjunction]] = {}
        self.is_cut = False

    def add(self, conjunction: Conjunction, accepts: TraceMask) -> None:
        """Add a conjunction, unless a shorter one accepts the same traces; ``accepts`` is the set of these traces.

        Longer conjunctions that accept the same traces are removed. At most ``ALIKE`` conjunctions
        are kept for one set of traces.
        """
        alike = self._groups.setdefault(accepts, [])
        if alike:
            size, shortest = count_atoms(conjunction), count_atoms(alike[0])
            if size > shortest or conjunction in alike:
                return
            if size < shortest:
                alike.clear()
        insort(alike, conjunction, key=sort_key)
        del alike[ALIKE:]
        if len(self._groups) > 2 * _MOST:
            self._cut()

    def items(self) -> Iterator[tuple[Conjunction, TraceMask]]:
        """Yield the conjunctions, each with the traces that it accepts."""
        return ((conjunction, accepts) for accepts, alike in self._groups.items() for conjunction in alike)

    def _cut(self) -> None:
        """Keep only the sets of accepted traces whose conjunctions have the best scores."""

        def score(group: tuple[TraceMask, list[Conjunction]]) -> float:
            accepts, alike = group
            return -figures(self._bits, accepts).score(count_atoms(alike[0]))

        self._groups = dict(sorted(self._groups.items(), key=score)[:_MOST])
        self.is_cut = True


def sort_key(conjunction: Conjunction) -> tuple[int, int, list[int], list[tuple[int, str]]]:
    """Return a sort key for conjunctions that accept the same traces.

    Conjunctions with fewer atoms come first, then those with fewer clauses. The rest is sorted by
    the templates and the texts of the clauses.
    """
    ranks, texts = [clause.rank for clause in conjunction], [(clause.atoms, clause.text) for clause in conjunction]
    return (count_atoms(conjunction), len(conjunction), ranks, texts)
