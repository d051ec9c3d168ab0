"""Products of two automata: find cycles that one accepts and the other rejects."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any

from tltlc.automaton.diagrams import Diagrams
from tltlc.automaton.infinite.cycles import Edge, Edges, marks_of, parts
from tltlc.automaton.infinite.graphs import components
from tltlc.automaton.infinite.mark_conditions import MarkClause, Marks, pair_clauses, pair_marks
from tltlc.automaton.work import Work

StatePair = tuple[Any, Any]
"""A state of the first automaton and a state of the second."""

Leaf = tuple[StatePair, Marks]
"""The states after a letter, and both automata's marks; the second's are numbered after the first's."""

Alternatives = Sequence[tuple[Sequence[MarkClause], Sequence[MarkClause]]]
"""Pairs of clauses to separate: one of the first clauses must accept a cycle, and none of the second ones may."""


def conditions(pairs: int, others: int) -> tuple[list[MarkClause], list[MarkClause]]:
    """Return the clauses of two automata, the first with ``pairs`` pairs and the second with ``others``."""
    return pair_clauses(pairs), pair_clauses(others, first=2 * pairs)


def product_leaves(
    letters: Diagrams[Any], pairs: int, is_over: Callable[[Any], bool]
) -> Callable[[int, int], list[Leaf]]:
    """Return a function that maps the steps of two automata to the successors in their product.

    Each automaton has ``pairs`` pairs.  The leaves of steps are targets with marks.  A leaf for
    which ``is_over`` holds has no target; it must be over in both automata on the same letters, and
    the product then has no successor.
    """
    memo: dict[tuple[int, int], int] = {}

    def together(one: Any, other: Any) -> Leaf | None:
        if is_over(one):
            return None
        return (one[0], other[0]), pair_marks(one[1]) | pair_marks(other[1], first=2 * pairs)

    def leaves(one: int, other: int) -> list[Leaf]:
        step = letters.apply(together, one, other, memo)
        return [leaf for leaf in letters.values(step) if leaf is not None]

    return leaves


def separating_component(
    starts: Iterable[StatePair], leaves: Callable[[StatePair], Sequence[Leaf]], alternatives: Alternatives, work: Work
) -> Edges | None:
    """Return a reachable strongly connected set of edges that meets one of ``alternatives``; None if none does.

    ``leaves`` returns the successors of a pair of states and is called once for each pair.  Raises
    OutOfWork.
    """
    known: dict[StatePair, Sequence[Leaf]] = {}

    def targets(both: StatePair) -> list[StatePair]:
        known[both] = leaves(both)
        return [target for target, _ in known[both]]

    for group in components(starts, targets):
        members = set(group)
        edges = [(both, target, marks) for both in group for target, marks in known[both] if target in members]
        for accepting, rejecting in alternatives if edges else ():
            if part := _separating_part(edges, accepting, rejecting, work):
                return part
    return None


def _separating_part(
    edges: Sequence[Edge], accepting: Sequence[MarkClause], rejecting: Sequence[MarkClause], work: Work
) -> Edges | None:
    """Return a strongly connected subset; None if there is none.

    One of the clauses ``accepting`` accepts it, and none of the clauses ``rejecting``.
    """
    for clause in accepting:
        # Removing edges is cheap; `parts` counts its own work.
        work.spend(1 + len(edges) // 128)
        stack = parts((edge for edge in edges if not edge[2] & clause.fins), work)
        while stack:
            part = stack.pop()
            marks = marks_of(part)
            if not clause.infs <= marks:
                continue
            met = next((clause for clause in rejecting if clause.accepts(marks)), None)
            if met is None:
                return part
            for mark in met.infs:
                stack += parts((edge for edge in part if mark not in edge[2]), work)
    return None
