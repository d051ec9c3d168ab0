"""Convert acceptance conditions to disjunctive normal form, with marks on edges in place of sets."""

from __future__ import annotations

from collections.abc import Collection

from tltlc.automaton.infinite.mark_conditions import MarkClause, MarkKind, Marks, Skeleton, clauses
from tltlc.automaton.work import Work
from tltlc.tools.hoa.tree import Hoa, HoaExpression


class Acceptance:
    """An acceptance condition in disjunctive normal form: one of the ``clauses`` must hold.

    Each distinct ``Fin`` or ``Inf`` term of the condition has a number, called its mark, and the
    clauses are about marks. An edge carries the mark of ``Fin(0)`` or ``Inf(0)`` if the edge is in
    set 0, and the mark of ``Fin(!0)`` or ``Inf(!0)`` if the edge is not in set 0.

    Raises :class:`~tltlc.automaton.work.OutOfWork` if the clauses take more work than is left.
    """

    def __init__(self, hoa: Hoa, work: Work) -> None:
        self._places: dict[tuple[MarkKind, int, bool], int] = {}
        skeleton = self._skeleton(hoa.condition)
        kinds: list[MarkKind] = [kind for kind, _, _ in self._places]
        disjuncts = clauses(skeleton, kinds, [None] * len(kinds), work)
        if isinstance(disjuncts, bool):
            disjuncts = [MarkClause(frozenset(), frozenset())] if disjuncts else []
        self.clauses = tuple(disjuncts)

    def marks(self, sets: Collection[int]) -> Marks:
        """Return the marks of an edge that is in exactly these acceptance sets."""
        return frozenset(place for (_, number, outside), place in self._places.items() if (number in sets) != outside)

    def _skeleton(self, term: HoaExpression) -> Skeleton:
        if term.op in ("fin", "inf"):
            number = term.value
            assert isinstance(number, int)
            kind: MarkKind = "fin" if term.op == "fin" else "inf"
            return ("leaf", self._places.setdefault((kind, number, term.outside), len(self._places)))
        if term.op in ("true", "false"):
            return ("and",) if term.op == "true" else ("or",)
        return (term.op, *map(self._skeleton, term.args))
