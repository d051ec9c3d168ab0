"""Products of two automata: find cycles that one accepts and the other rejects."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any

from tltlc.automaton.diagrams import Diagrams
from tltlc.automaton.infinite.cycles import Edge, Edges, marks_of, parts
from tltlc.automaton.infinite.graphs import components
from tltlc.automaton.infinite.mark_conditions import MarkClause, Marks, pair_clauses, pair_marks
from tltlc.automaton.work import Work

Both = tuple[Any, Any]
"""A state of the first automaton and a state of the second."""

Leaf = tuple[Both, Marks]
"""The states after a letter, and both automata's marks; the second's are numbered after the first's."""

Ways = Sequence[tuple[Sequence[MarkClause], Sequence[MarkClause]]]
"""Alternatives: the clauses of which one must accept a cycle, and the clauses of which none may."""


def conditions(pairs: int, others: int) -> tuple[list[MarkClause], list[MarkClause]]:
    """Return the clauses of two automata, the first with ``pairs`` pairs and the second with ``others``."""
    return pair_clauses(pairs), pair_clauses(others, first=2 * pairs)


def side_by_side(
    letters: Diagrams[Any], pairs: int, is_over: Callable[[Any], bool]
) -> Callable[[int, int], list[Leaf]]:
    """Return a function that maps the steps of two automata to the successors in their product.

    Each automaton has ``pairs`` pairs.  The leaves of steps are targets with marks.  If a leaf of
    the first automaton ``is_over``, the second automaton's leaf must be too, and the product has no
    successor.
    """
    memo: dict[tuple[int, int], int] = {}

    def together(one: Any, other: Any) -> Leaf | None:
        if is_over(one):
            return None
        return (one[0], other[0]), pair_marks(one[1]) | pair_marks(other[1], first=2 * pairs)

    def leaves(one: int, other: int) -> list[Leaf]:
        step = letters.combined(together, one, other, memo)
        return [leaf for leaf in letters.values(step) if leaf is not None]

    return leaves


def separating_component(
    starts: Iterable[Both], leaves: Callable[[Both], Sequence[Leaf]], ways: Ways, work: Work
) -> Edges | None:
    """Return a reachable strongly connected set of edges that meets one of the alternatives
    ``ways``; None if none does.

    ``leaves`` returns the successors of a pair of states and is called once for each pair.  Raises
    OutOfWork.
    """
    known: dict[Both, Sequence[Leaf]] = {}

    def targets(both: Both) -> list[Both]:
        known[both] = leaves(both)
        return [target for target, _ in known[both]]

    for group in components(starts, targets):
        members = set(group)
        edges = [(both, target, marks) for both in group for target, marks in known[both] if target in members]
        for these, those in ways if edges else ():
            if part := _only_here(edges, these, those, work):
                return part
    return None


def _only_here(
    edges: Sequence[Edge], these: Sequence[MarkClause], those: Sequence[MarkClause], work: Work
) -> Edges | None:
    """Return a strongly connected subset that ``these`` clauses accept and ``those`` reject; None if there is none."""
    for clause in these:
        # Removing edges is cheap; `parts` counts its own work.
        work.spend(1 + len(edges) // 128)
        stack = parts((edge for edge in edges if not edge[2] & clause.fins), work)
        while stack:
            part = stack.pop()
            marks = marks_of(part)
            if not clause.infs <= marks:
                continue
            accepting = next((clause for clause in those if clause.accepts(marks)), None)
            if accepting is None:
                return part
            for mark in accepting.infs:
                stack += parts((edge for edge in part if mark not in edge[2]), work)
    return None
