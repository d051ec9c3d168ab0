"""Products of two automata: find cycles that one accepts and the other rejects."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any

from tltlc.automaton.diagrams import Diagrams
from tltlc.automaton.infinite.cycles import MarkedEdge, MarkedEdges, marks_of, parts
from tltlc.automaton.infinite.graphs import components
from tltlc.automaton.infinite.mark_conditions import MarkClause, Marks, pair_clauses, pair_marks
from tltlc.automaton.work import Work

StatePair = tuple[Any, Any]
"""A state of the first automaton and a state of the second."""

PairLeaf = tuple[StatePair, Marks]
"""The states after a letter, and the marks of both edges; the second automaton's marks have the higher numbers."""

Alternatives = Sequence[tuple[Sequence[MarkClause], Sequence[MarkClause]]]
"""Conditions on a cycle, each a pair of lists of clauses.

A cycle meets the condition if a clause of the first list accepts the marks of the cycle, and no
clause of the second list does.
"""


def conditions(pairs: int, others: int) -> tuple[list[MarkClause], list[MarkClause]]:
    """Return the acceptance conditions of two automata with ``pairs`` and ``others`` Rabin pairs, as clauses.

    The marks of the second automaton are numbered after the marks of the first.
    """
    return pair_clauses(pairs), pair_clauses(others, first=2 * pairs)


def product_leaves(
    letters: Diagrams[Any], pairs: int, is_over: Callable[[Any], bool]
) -> Callable[[int, int], list[PairLeaf]]:
    """Return a function that lists the successors of a pair of states in the product of two automata.

    The function takes the steps of the two states, nodes of ``letters``. A step maps each letter to
    a target and marks. Each automaton has ``pairs`` Rabin pairs. ``is_over`` says whether a value
    of a step has no target; on such a letter, the pair of states has no successor. A letter must
    have a target in both automata or in neither.
    """
    memo: dict[tuple[int, int], int] = {}

    def together(one: Any, other: Any) -> PairLeaf | None:
        if is_over(one):
            return None
        return (one[0], other[0]), pair_marks(one[1]) | pair_marks(other[1], first=2 * pairs)

    def leaves(one: int, other: int) -> list[PairLeaf]:
        step = letters.apply(together, one, other, memo)
        return [leaf for leaf in letters.values(step) if leaf is not None]

    return leaves


def separating_component(
    starts: Iterable[StatePair],
    leaves: Callable[[StatePair], Sequence[PairLeaf]],
    alternatives: Alternatives,
    work: Work,
) -> MarkedEdges | None:
    """Return a strongly connected set of edges that meets one of ``alternatives``; None if no set does.

    The edges belong to a product of two automata, and can be reached from ``starts``. An
    alternative is two lists of clauses. The set meets an alternative if a clause of the first list
    accepts the marks of the set, and no clause of the second list does. ``leaves`` returns the
    successors of a pair of states; it is called once for each pair. Raises OutOfWork.
    """
    known: dict[StatePair, Sequence[PairLeaf]] = {}

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
    edges: Sequence[MarkedEdge], accepting: Sequence[MarkClause], rejecting: Sequence[MarkClause], work: Work
) -> MarkedEdges | None:
    """Return a strongly connected subset of ``edges`` that ``accepting`` accepts and ``rejecting`` does not.

    That is, a clause of ``accepting`` accepts the marks of the subset, and no clause of
    ``rejecting`` does. Returns None if there is no such subset. Raises OutOfWork.
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
