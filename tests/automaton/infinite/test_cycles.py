"""The alternating cycle decomposition counts all of its work, so that a budget stops it."""

from __future__ import annotations

import pytest

from tests.calls import calls
from tltlc.automaton.infinite.cycles import MarkedEdge, decomposition
from tltlc.automaton.infinite.mark_conditions import MarkClause, Marks
from tltlc.automaton.infinite.products import separating_component
from tltlc.automaton.work import OutOfWork, Work

NONE: Marks = frozenset()
SIZE = 200
BUDGET = 20_000
MOST_CALLS = 20 * BUDGET


def ring(marks: Marks) -> list[MarkedEdge]:
    """Return a cycle of ``SIZE`` edges that all have these marks."""
    return [(state, (state + 1) % SIZE, marks) for state in range(SIZE)]


def spends(edges: list[MarkedEdge], clauses: list[MarkClause]) -> int:
    """Return the number of calls that a decomposition makes until it runs out of its budget."""

    def work() -> None:
        with pytest.raises(OutOfWork):
            decomposition(edges, clauses, Work(BUDGET))

    return calls(work)


def test_clauses_without_edges_count_as_work() -> None:
    clauses = [MarkClause(frozenset((0,)), frozenset((number,))) for number in range(1, 20_000)]
    assert spends(ring(frozenset((0,))), clauses) < MOST_CALLS


def test_rejected_sets_count_as_work() -> None:
    marks = frozenset(range(2_000))
    clauses = [MarkClause(NONE, frozenset(range(2_000)))] * 1_000
    assert spends(ring(marks), clauses) < MOST_CALLS


def test_a_comparison_counts_clauses_without_edges() -> None:
    one = [MarkClause(frozenset((0,)), frozenset((number,))) for number in range(1, 20_000)]

    def work() -> None:
        with pytest.raises(OutOfWork):
            separating_component(
                [(0, 0)],
                lambda both: [(((both[0] + 1) % SIZE, 0), frozenset((0,)))],
                [(one, [])],
                Work(BUDGET),
            )

    assert calls(work) < MOST_CALLS
