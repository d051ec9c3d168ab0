"""Boolean combinations of marks: which marks must come infinitely often, which may only come finitely often."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import product
from typing import Any, Literal

from tltlc.automaton.fspa import Mark
from tltlc.automaton.infinite.work import Work
from tltlc.core.record import record

Kind = Literal["inf", "fin"]
"""Whether marks must come infinitely often, or finitely often."""

Marks = frozenset[int]
"""What a letter is marked with: the places of parts, or of pairs the numbers of :func:`pair_marks`."""

Skeleton = tuple[Any, ...]
"""``("leaf", index)``, ``("and", …)`` or ``("or", …)``."""


@record
class Clause:
    """A run is accepted that takes every set of ``infs`` infinitely often, and none of ``fins``."""

    fins: Marks
    infs: Marks

    def accepts(self, marks: Marks) -> bool:
        """Whether these are the marks of a run, taken infinitely often, that is accepted."""
        return self.infs <= marks and self.fins.isdisjoint(marks)


def pair_marks(marks: Iterable[Mark], first: int = 0) -> Marks:
    """Marks of Rabin pairs as numbers, two for each pair from ``first`` on: the even one for ``fin``."""
    return frozenset(first + 2 * pair + (kind == "inf") for pair, kind in marks)


def pair_clauses(pairs: int, first: int = 0) -> list[Clause]:
    """So many Rabin pairs as clauses over the numbers of :func:`pair_marks`."""
    return [Clause(frozenset((fin,)), frozenset((fin + 1,))) for fin in range(first, first + 2 * pairs, 2)]


def clauses(
    skeleton: Skeleton, kinds: Sequence[Kind], values: Sequence[bool | None], work: Work
) -> list[Clause] | bool:
    """The disjunctive normal form of a skeleton over parts of these kinds; True or False where it is constant.

    ``values`` has True or False for a part that is settled, None for the others.  Raises OutOfWork where there are too
    many clauses.
    """
    found = _clauses(skeleton, kinds, values, work)
    if not found:
        return False
    if any(not each.fins and not each.infs for each in found):
        return True
    return found


def _clauses(skeleton: Skeleton, kinds: Sequence[Kind], values: Sequence[bool | None], work: Work) -> list[Clause]:
    if skeleton[0] == "leaf":
        index = skeleton[1]
        if values[index] is not None:
            return [Clause(frozenset(), frozenset())] if values[index] else []
        one = frozenset((index,))
        return [Clause(one, frozenset()) if kinds[index] == "fin" else Clause(frozenset(), one)]
    below = [_clauses(each, kinds, values, work) for each in skeleton[1:]]
    work.spend(len(below))
    if skeleton[0] == "or":
        return _minimal([each for group in below for each in group], work)
    result = [Clause(frozenset(), frozenset())]
    for group in below:
        work.spend(len(result) * len(group) // 4)
        result = _minimal([Clause(x.fins | y.fins, x.infs | y.infs) for x, y in product(result, group)], work)
    return result


def _minimal(found: list[Clause], work: Work) -> list[Clause]:
    """Without those that another one covers."""
    distinct = list(dict.fromkeys(found))
    work.spend(len(distinct) ** 2 // 16)
    return [
        each
        for each in distinct
        if not any(other is not each and other.fins <= each.fins and other.infs <= each.infs for other in distinct)
    ]
