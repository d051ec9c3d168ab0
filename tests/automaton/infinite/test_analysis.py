"""Goals, verdicts and the default judge, from their definitions: by every set of edges that a run may take for ever."""

from __future__ import annotations

from itertools import combinations

from hypothesis import given, settings
from hypothesis import strategies as st

from tltlc.automaton.infinite.analysis import Analysis
from tltlc.automaton.infinite.cycles import Edge
from tltlc.automaton.infinite.work import Work

PAIRS = 2
marks = st.frozensets(st.integers(0, 2 * PAIRS - 1), max_size=3)


@st.composite
def graphs(draw: st.DrawFn) -> tuple[int, list[Edge]]:
    """States that each have an edge at least, and what their edges are marked with."""
    states = draw(st.integers(1, 4))
    numbers = st.integers(0, states - 1)
    edges: list[Edge] = [(state, draw(numbers), draw(marks)) for state in range(states)]
    edges += draw(st.lists(st.tuples(numbers, numbers, marks), max_size=4))
    return states, list(dict.fromkeys(edges))


def for_ever(edges: list[Edge]) -> list[tuple[Edge, ...]]:
    """Every set of edges that some run takes infinitely often, and no others."""
    chosen = (some for size in range(1, len(edges) + 1) for some in combinations(edges, size))
    return [some for some in chosen if _is_strongly_connected(some)]


def _is_strongly_connected(edges: tuple[Edge, ...]) -> bool:
    states = {state for source, target, _ in edges for state in (source, target)}
    return all(states <= reached(state, edges) for state in states)


def reached(state: int, edges: tuple[Edge, ...] | list[Edge]) -> set[int]:
    found, queue = {state}, [state]
    for each in queue:
        for source, target, _ in edges:
            if source == each and target not in found:
                found.add(target)
                queue.append(target)
    return found


def accepted(edges: tuple[Edge, ...]) -> bool:
    met = {mark for edge in edges for mark in edge[2]}
    return any(2 * pair not in met and 2 * pair + 1 in met for pair in range(PAIRS))


def touched(sets: list[tuple[Edge, ...]]) -> set[int]:
    return {state for edges in sets for source, target, _ in edges for state in (source, target)}


@settings(max_examples=200, deadline=None)
@given(graphs())
def test_goals_verdicts_and_judge_are_what_runs_say(graph: tuple[int, list[Edge]]) -> None:
    states, edges = graph
    analysis = Analysis(states, edges, PAIRS, Work(1_000_000))
    cycles = for_ever(edges)
    goals = touched([some for some in cycles if accepted(some)])
    rejected = touched([some for some in cycles if not accepted(some)])
    assert analysis.goals == goals
    verdicts = []
    for state in range(states):
        after = reached(state, edges)
        if not after & goals:
            verdicts.append("violated")
        elif not after & rejected:
            verdicts.append("satisfied")
        else:
            verdicts.append("holding" if state in goals else "pending")
    assert [analysis.verdict(state) for state in range(states)] == verdicts
    alive = [edge for edge in edges if verdicts[edge[1]] != "violated"]
    vain = touched([some for some in for_ever(alive) if not accepted(some)])
    staying_suffices = not any(reached(goal, alive) & vain for goal in goals)
    assert analysis.default_judge() == ("goal" if 0 not in goals and staying_suffices else "limit")


@given(graphs())
def test_successors_are_those_of_the_edges_in_their_order(graph: tuple[int, list[Edge]]) -> None:
    states, edges = graph
    targets = Analysis(states, edges, PAIRS, Work(1_000_000)).targets
    for state in range(states):
        assert targets[state] == list(dict.fromkeys(edge[1] for edge in edges if edge[0] == state))
