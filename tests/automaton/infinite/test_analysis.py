"""Goals, verdicts and the default judge agree with their definitions.

The tests enumerate every set of edges that a run may take forever.
"""

from __future__ import annotations

from itertools import combinations

from hypothesis import given
from hypothesis import strategies as st

from tests.fuzzing import times
from tltlc.automaton.infinite.analysis import Analysis
from tltlc.automaton.infinite.cycles import MarkedEdge
from tltlc.automaton.work import Work

PAIRS = 2
marks = st.frozensets(st.integers(0, 2 * PAIRS - 1), max_size=3)


@st.composite
def graphs(draw: st.DrawFn) -> tuple[int, list[MarkedEdge]]:
    """Draw a number of states, and marked edges; every state has at least one edge."""
    states = draw(st.integers(1, 4))
    numbers = st.integers(0, states - 1)
    edges: list[MarkedEdge] = [(state, draw(numbers), draw(marks)) for state in range(states)]
    edges += draw(st.lists(st.tuples(numbers, numbers, marks), max_size=4))
    return states, list(dict.fromkeys(edges))


def recurring_sets(edges: list[MarkedEdge]) -> list[tuple[MarkedEdge, ...]]:
    """Return every set of edges that is exactly what some run takes infinitely often."""
    subsets = (subset for size in range(1, len(edges) + 1) for subset in combinations(edges, size))
    return [subset for subset in subsets if _is_strongly_connected(subset)]


def _is_strongly_connected(edges: tuple[MarkedEdge, ...]) -> bool:
    states = {state for source, target, _ in edges for state in (source, target)}
    return all(states <= reachable(state, edges) for state in states)


def reachable(start: int, edges: tuple[MarkedEdge, ...] | list[MarkedEdge]) -> set[int]:
    states, queue = {start}, [start]
    for state in queue:
        for source, target, _ in edges:
            if source == state and target not in states:
                states.add(target)
                queue.append(target)
    return states


def is_accepted(edges: tuple[MarkedEdge, ...]) -> bool:
    met = {mark for edge in edges for mark in edge[2]}
    return any(2 * pair not in met and 2 * pair + 1 in met for pair in range(PAIRS))


def endpoints(sets: list[tuple[MarkedEdge, ...]]) -> set[int]:
    return {state for edges in sets for source, target, _ in edges for state in (source, target)}


@times(80)
@given(graphs())
def test_goals_verdicts_and_judge_match_their_definitions(graph: tuple[int, list[MarkedEdge]]) -> None:
    states, edges = graph
    analysis = Analysis(states, edges, PAIRS, Work(1_000_000))
    cycles = recurring_sets(edges)
    goals = endpoints([cycle for cycle in cycles if is_accepted(cycle)])
    rejected = endpoints([cycle for cycle in cycles if not is_accepted(cycle)])
    assert analysis.goals == goals
    verdicts = []
    for state in range(states):
        after = reachable(state, edges)
        if not after & goals:
            verdicts.append("violated")
        elif not after & rejected:
            verdicts.append("satisfied")
        else:
            verdicts.append("holding" if state in goals else "pending")
    assert [analysis.verdict(state) for state in range(states)] == verdicts
    alive = [edge for edge in edges if verdicts[edge[1]] != "violated"]
    vain = endpoints([cycle for cycle in recurring_sets(alive) if not is_accepted(cycle)])
    staying_suffices = not any(reachable(goal, alive) & vain for goal in goals)
    assert analysis.default_judge() == ("goal" if 0 not in goals and staying_suffices else "limit")


@given(graphs())
def test_targets_follow_the_order_of_the_edges(graph: tuple[int, list[MarkedEdge]]) -> None:
    states, edges = graph
    targets = Analysis(states, edges, PAIRS, Work(1_000_000)).targets
    for state in range(states):
        assert targets[state] == list(dict.fromkeys(edge[1] for edge in edges if edge[0] == state))
