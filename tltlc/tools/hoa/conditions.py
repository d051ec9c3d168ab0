"""Acceptance conditions as clauses over marks."""

from __future__ import annotations

from collections.abc import Collection

from tltlc.automaton.infinite.mark_conditions import Clause, Kind, Marks, Skeleton, clauses
from tltlc.automaton.infinite.work import Work
from tltlc.tools.hoa.tree import Hoa, Term


class Acceptance:
    """The disjunctive normal form of a condition; a mark stands for a ``Fin`` or ``Inf`` that is in it.

    Raises :class:`~tltlc.automaton.infinite.work.OutOfWork` where there are too many.
    """

    def __init__(self, hoa: Hoa, work: Work) -> None:
        self._places: dict[tuple[Kind, int, bool], int] = {}
        skeleton = self._skeleton(hoa.condition)
        kinds: list[Kind] = [kind for kind, _, _ in self._places]
        found = clauses(skeleton, kinds, [None] * len(kinds), work)
        if isinstance(found, bool):
            found = [Clause(frozenset(), frozenset())] if found else []
        self.clauses = tuple(found)

    def marks(self, sets: Collection[int]) -> Marks:
        """The marks of an edge that is in these sets."""
        return frozenset(place for (_, each, outside), place in self._places.items() if (each in sets) != outside)

    def _skeleton(self, term: Term) -> Skeleton:
        if term.op in ("fin", "inf"):
            number = term.value
            assert isinstance(number, int)
            kind: Kind = "fin" if term.op == "fin" else "inf"
            return ("leaf", self._places.setdefault((kind, number, term.outside), len(self._places)))
        if term.op in ("true", "false"):
            return ("and",) if term.op == "true" else ("or",)
        return (term.op, *map(self._skeleton, term.args))
