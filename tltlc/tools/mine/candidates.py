"""The candidates that a search keeps: of those that accept the same traces, a few of the shortest."""

from __future__ import annotations

from bisect import insort
from collections.abc import Iterator
from typing import Final

from tltlc.io.limits import WORK
from tltlc.tools.mine.bits import Bits, Verdicts
from tltlc.tools.mine.clause import Conjunction, atoms_of
from tltlc.tools.mine.measure import figures

ALIKE: Final = 3
"""How many candidates of one length that accept the same traces are kept."""
_MOST: Final = WORK["mined candidates"]


class Candidates:
    """Conjunctions with the traces that they accept.

    It holds what :func:`~tltlc.tools.mine.conjunctions.best` would choose from all that were added, so its size
    depends on
    how many different sets of traces they accept.  Where these are too many, it keeps those with the best scores, and
    ``is_cut`` becomes true.
    """

    def __init__(self, bits: Bits) -> None:
        self._bits = bits
        self._groups: dict[Verdicts, list[Conjunction]] = {}
        self.is_cut = False

    def add(self, conjunction: Conjunction, accepts: Verdicts) -> None:
        """Keep a conjunction, unless shorter ones accept the same traces, or enough that are as short."""
        alike = self._groups.setdefault(accepts, [])
        if alike:
            size, shortest = atoms_of(conjunction), atoms_of(alike[0])
            if size > shortest or conjunction in alike:
                return
            if size < shortest:
                alike.clear()
        insort(alike, conjunction, key=length)
        del alike[ALIKE:]
        if len(self._groups) > 2 * _MOST:
            self._cut()

    def items(self) -> Iterator[tuple[Conjunction, Verdicts]]:
        """The conjunctions, each with the traces that it accepts."""
        return ((each, accepts) for accepts, alike in self._groups.items() for each in alike)

    def _cut(self) -> None:
        """Keep the groups with the best scores."""

        def score(group: tuple[Verdicts, list[Conjunction]]) -> float:
            accepts, alike = group
            return -figures(self._bits, accepts).score(atoms_of(alike[0]))

        self._groups = dict(sorted(self._groups.items(), key=score)[:_MOST])
        self.is_cut = True


def length(conjunction: Conjunction) -> tuple[int, int, list[int], list[tuple[int, str]]]:
    """The order among conjunctions that accept the same traces: the shortest first, then by template and text."""
    ranks, texts = [each.rank for each in conjunction], [(each.atoms, each.text) for each in conjunction]
    return (atoms_of(conjunction), len(conjunction), ranks, texts)
