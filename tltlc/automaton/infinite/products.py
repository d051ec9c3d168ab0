"""Products of two automata, which are read in step: cycles that the one accepts and the other does not."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any

from tltlc.automaton.infinite.cycles import Edge, Edges, marks_of, parts
from tltlc.automaton.infinite.graphs import components
from tltlc.automaton.infinite.letters import Letters
from tltlc.automaton.infinite.mark_conditions import Clause, Marks, pair_clauses, pair_marks
from tltlc.automaton.infinite.work import Work

Both = tuple[Any, Any]
"""A state of the one automaton and one of the other."""

Leaf = tuple[Both, Marks]
"""The states after a letter, and the marks of both: those of the other one come behind those of the first."""

Ways = Sequence[tuple[Sequence[Clause], Sequence[Clause]]]
"""What is to accept a cycle, and what is not to."""


def conditions(pairs: int, others: int) -> tuple[list[Clause], list[Clause]]:
    """What the one automaton accepts, which has so many pairs, and what the other one, which has ``others``."""
    return pair_clauses(pairs), pair_clauses(others, first=2 * pairs)


def side_by_side(letters: Letters[Any], pairs: int, is_over: Callable[[Any], bool]) -> Callable[[int, int], list[Leaf]]:
    """Of the steps of two automata with so many pairs each, where letters lead from both.

    Leaves of steps are targets with marks; where one of the first automaton ``is_over``, so is the other's.
    """
    memo: dict[tuple[int, int], int] = {}

    def together(one: Any, other: Any) -> Leaf | None:
        if is_over(one):
            return None
        return (one[0], other[0]), pair_marks(one[1]) | pair_marks(other[1], first=2 * pairs)

    def leaves(one: int, other: int) -> list[Leaf]:
        found = letters.combined(together, one, other, memo)
        return [leaf for leaf in letters.values(found) if leaf is not None]

    return leaves


def telling_apart(
    starts: Iterable[Both], leaves: Callable[[Both], Sequence[Leaf]], ways: Ways, work: Work
) -> Edges | None:
    """A strongly connected set of edges that is reached and accepted in one of these ways; None where none is.

    ``leaves`` gives what letters lead to from two states, and is asked once for each.  Raises OutOfWork.
    """
    known: dict[Both, Sequence[Leaf]] = {}

    def targets(both: Both) -> list[Both]:
        known[both] = leaves(both)
        return [target for target, _ in known[both]]

    for group in components(starts, targets):
        members = set(group)
        edges = [(both, target, marks) for both in group for target, marks in known[both] if target in members]
        for these, those in ways if edges else ():
            if found := _only_here(edges, these, those, work):
                return found
    return None


def _only_here(edges: Sequence[Edge], these: Sequence[Clause], those: Sequence[Clause], work: Work) -> Edges | None:
    """A strongly connected set of edges that is accepted by these clauses and not by those; None where none is."""
    for clause in these:
        # Leaving out edges takes little; the parts that are left count for themselves.
        work.spend(1 + len(edges) // 128)
        stack = parts((edge for edge in edges if not edge[2] & clause.fins), work)
        while stack:
            part = stack.pop()
            marks = marks_of(part)
            if not clause.infs <= marks:
                continue
            met = next((each for each in those if each.accepts(marks)), None)
            if met is None:
                return part
            for mark in met.infs:
                stack += parts((edge for edge in part if mark not in edge[2]), work)
    return None
