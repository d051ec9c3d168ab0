"""Products of automata: cycles that one automaton accepts and the other rejects."""

from __future__ import annotations

import pytest

from tltlc.automaton.infinite.products import PairLeaf, StatePair, conditions, separating_component
from tltlc.automaton.work import OutOfWork, Work

START, OVER = (0, 0), (1, 1)
ONE_FIN, ONE_INF, OTHER_FIN, OTHER_INF = range(4)
"""The marks of two automata with one pair each."""


def loops(*marks: set[int]) -> dict[StatePair, list[PairLeaf]]:
    """Return two states on one cycle, with a loop at the second state for each set of marks."""
    leaves = [(OVER, frozenset(loop_marks)) for loop_marks in marks]
    return {START: [(OVER, frozenset())], OVER: [(START, frozenset()), *leaves]}


@pytest.mark.parametrize(
    ("graph", "ways"),
    [
        (loops({ONE_INF}), (True, False)),
        (loops({OTHER_INF}), (False, True)),
        (loops({ONE_INF, OTHER_INF}), (False, False)),
        (loops({ONE_INF}, {OTHER_INF}), (True, True)),
        (loops({ONE_INF, OTHER_INF}, {OTHER_FIN}), (True, False)),
        (loops({ONE_INF, ONE_FIN}), (False, False)),
        ({START: [(OVER, frozenset({ONE_INF}))], OVER: []}, (False, False)),
    ],
)
def test_cycles_that_only_one_automaton_accepts_are_found(
    graph: dict[StatePair, list[PairLeaf]], ways: tuple[bool, bool]
) -> None:
    one, other = conditions(1, 1)
    visited: list[StatePair] = []

    def leaves(both: StatePair) -> list[PairLeaf]:
        visited.append(both)
        return graph[both]

    for way, expected in zip(((one, other), (other, one)), ways, strict=True):
        cycle = separating_component([START], graph.__getitem__, [way], Work(1000))
        assert (cycle is not None) == expected
        for source, target, marks in cycle or ():
            assert (target, marks) in graph[source]
    either = separating_component([START], leaves, [(one, other), (other, one)], Work(1000))
    assert (either is not None) == any(ways)
    assert sorted(visited) == [START, OVER], "the successors of each pair are computed once"


def test_the_search_stops_when_its_work_is_used_up() -> None:
    with pytest.raises(OutOfWork):
        separating_component([START], loops({ONE_INF}).__getitem__, [conditions(1, 1)], Work(1))
