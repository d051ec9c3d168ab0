"""Acceptance conditions over the marks of edges.

A condition says which marks a run must take infinitely often, and which only finitely often.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import product
from typing import Any, Literal

from tltlc.automaton.fspa import Mark
from tltlc.automaton.work import Work
from tltlc.core.record import record

MarkKind = Literal["inf", "fin"]
"""Whether a run must take a mark infinitely often (``inf``) or only finitely often (``fin``)."""

Marks = frozenset[int]
"""The marks of an edge, as ints: indices of a formula's parts, or the numbers that :func:`pair_marks` returns."""

Skeleton = tuple[Any, ...]
"""The Boolean structure of a formula over its parts: ``("leaf", index)``, ``("and", …)`` or ``("or", …)``.

``index`` is the index of a part; the operands of ``and`` and ``or`` are skeletons.
"""


@record
class MarkClause:
    """A condition on a run: it takes all marks of ``infs``, and no mark of ``fins``, infinitely often.

    A run takes a mark when it takes an edge with this mark.
    """

    fins: Marks
    infs: Marks

    def accepts(self, marks: Marks) -> bool:
        """Whether a run that takes exactly these marks infinitely often is accepted."""
        return self.infs <= marks and self.fins.isdisjoint(marks)


def pair_marks(marks: Iterable[Mark], first: int = 0) -> Marks:
    """Return marks of Rabin pairs as numbers.

    The mark ``(i, "fin")`` has the number ``first + 2 * i``, and ``(i, "inf")`` has
    ``first + 2 * i + 1``.
    """
    return frozenset(first + 2 * pair + (kind == "inf") for pair, kind in marks)


def pair_clauses(pairs: int, first: int = 0) -> list[MarkClause]:
    """Return, for each of ``pairs`` Rabin pairs, the condition that a run meets the pair.

    The marks are numbered as by :func:`pair_marks`: the mark ``fin`` of pair ``i`` is
    ``first + 2 * i``, and the mark ``inf`` is ``first + 2 * i + 1``.
    """
    return [MarkClause(frozenset((fin,)), frozenset((fin + 1,))) for fin in range(first, first + 2 * pairs, 2)]


def clauses(
    skeleton: Skeleton, kinds: Sequence[MarkKind], values: Sequence[bool | None], work: Work
) -> list[MarkClause] | bool:
    """Return conditions on marks; a run satisfies the formula if it meets at least one of them.

    ``skeleton`` is the formula, with the indices of its parts as leaves. Part ``i`` holds if the
    run takes mark ``i`` infinitely often (``kinds[i]`` is ``inf``) or only finitely often
    (``fin``). If the truth of part ``i`` is known already, it is ``values[i]``; otherwise
    ``values[i]`` is None. Returns True or False if the formula is constant. Raises OutOfWork if
    there are too many conditions.
    """
    result = _clauses(skeleton, kinds, values, work)
    if not result:
        return False
    if any(not clause.fins and not clause.infs for clause in result):
        return True
    return result


def _clauses(
    skeleton: Skeleton, kinds: Sequence[MarkKind], values: Sequence[bool | None], work: Work
) -> list[MarkClause]:
    if skeleton[0] == "leaf":
        index = skeleton[1]
        if values[index] is not None:
            return [MarkClause(frozenset(), frozenset())] if values[index] else []
        one = frozenset((index,))
        return [MarkClause(one, frozenset()) if kinds[index] == "fin" else MarkClause(frozenset(), one)]
    below = [_clauses(operand, kinds, values, work) for operand in skeleton[1:]]
    work.spend(len(below))
    if skeleton[0] == "or":
        return _drop_covered([clause for group in below for clause in group], work)
    result = [MarkClause(frozenset(), frozenset())]
    for group in below:
        work.spend(len(result) * len(group) // 4)
        result = _drop_covered([MarkClause(x.fins | y.fins, x.infs | y.infs) for x, y in product(result, group)], work)
    return result


def _drop_covered(disjuncts: list[MarkClause], work: Work) -> list[MarkClause]:
    """Return the clauses without duplicates, and without the clauses that imply another clause."""
    distinct = list(dict.fromkeys(disjuncts))
    work.spend(len(distinct) ** 2 // 16)
    return [
        clause
        for clause in distinct
        if not any(
            other is not clause and other.fins <= clause.fins and other.infs <= clause.infs for other in distinct
        )
    ]
