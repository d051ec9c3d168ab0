"""Fold several runs of states that count at the same time, as in `F[0,100] a & F[0,100] b`.

A run is a path of states that differ only in a count. Several runs that count together are parallel.
Their n-th *counting state* is the tuple of the n-th states of the runs; the inner counting states
are all except the first and the last one. An edge from a state in one counting state leads to a
state in the next one, of the same run or another, or out of the parallel runs.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from tltlc.automaton.fspa import Fspa, State
from tltlc.backends.drawing.folding import LEAST_FOLDED, Drawing, DrawnEdge, EdgeLabel, whole_drawing
from tltlc.core.record import replace

CountingState = tuple[int, ...]
"""The states at the same place of several parallel runs: one state of each run."""
EdgeTargets = Mapping[int, Mapping[EdgeLabel, int]]
"""For each state and each label of an edge that leaves it, the target of the edge."""


def fold_parallel_runs(fspa: Fspa) -> Drawing:
    """Return a drawing in which the inner states of parallel runs are folded: each run keeps only its first one.

    A run is a path of states that differ only in a count, and its inner states are all except the
    first and the last. Runs are parallel if they count at the same time. Any two states that follow
    each other in one of several parallel runs have these properties:

    - They have the same verdict, the same acceptance and the same labels of edges.
    - Their edges with the same label lead to one state, or to two states that follow each other in
      one of the runs.
    - If the second state is an inner one, all edges to it come from states one place before it.

    The edge along a run would lead from the folded state to itself. It is drawn to the last state of
    the run instead.
    """
    states, all_edges = fspa.states, whole_drawing(fspa).edges
    runs = [run for path in _paths(states, all_edges) for run in zip(*path, strict=True)]
    first = {state: run[0] for run in runs for state in run[:-1]}
    last = {run[0]: run[-1] for run in runs}
    edges = (_redirect(edge, first, last) for edge in all_edges if first.get(edge.source, edge.source) == edge.source)
    return Drawing(
        tuple(state for state in states if first.get(state.id, state.id) == state.id),
        tuple(edges),
        {run[0]: tuple(states[state] for state in run[:-1]) for run in runs},
    )


def _redirect(edge: DrawnEdge, first: Mapping[int, int], last: Mapping[int, int]) -> DrawnEdge:
    """Return an edge whose target is a state that is drawn.

    If the target is an inner state of a run, replace it by the first inner state of the run. If the
    edge then leads from this state to itself, replace it by the last state of the run. ``first`` maps
    each inner state of a run to the first inner state, and ``last`` maps the first inner state to
    the last state.
    """
    target = first.get(edge.target, edge.target)
    return replace(edge, target=last[target] if target == edge.source and target in last else target)


def _paths(states: Sequence[State], edges: Sequence[DrawnEdge]) -> list[list[CountingState]]:
    """Return the path of counting states of each group of parallel runs that is folded.

    A path has the inner counting states of the group, and then the last one.
    """
    steps: dict[int, dict[EdgeLabel, int]] = {state.id: {} for state in states}
    entering: list[set[int]] = [set() for _ in states]
    for edge in edges:
        steps[edge.source][edge.label] = edge.target
        entering[edge.target].add(edge.source)
    paths: list[list[CountingState]] = []
    used_states: set[int] = set()
    for edge in edges:
        if not used_states & {edge.source, edge.target}:
            for path in _paths_from((edge.source,), (edge.target,), states, steps, entering):
                if used_states.isdisjoint(state for counting in path for state in counting):
                    paths.append(path)
                    used_states.update(state for counting in path[:-1] for state in counting)
    return paths


def _paths_from(
    counting: CountingState,
    following: CountingState,
    states: Sequence[State],
    steps: EdgeTargets,
    entering: Sequence[set[int]],
) -> list[list[CountingState]]:
    """Return the paths of counting states, in order, that start with ``following``, the one after ``counting``.

    A path ends at a counting state whose states do not continue the runs. Where the number of runs
    changes, a new path begins. Paths with too few inner counting states to be folded are left out.
    """
    paths: list[list[CountingState]] = []
    path: list[CountingState] = []
    seen = set(counting)
    while pairs := _next_states(counting, following, states, steps):
        is_entered = any(not state or not entering[state] <= set(counting) for state in pairs)
        if is_entered or not seen.isdisjoint(pairs) or len(set(pairs.values())) < len(pairs):
            break
        if path and len(pairs) != len(counting):
            paths.append(path)
            path = []
        counting = following if len(pairs) == len(following) else tuple(pairs)
        following = tuple(pairs[state] for state in counting)
        seen.update(counting)
        path.append(counting)
    return [candidate for candidate in (*paths, path) if len(candidate) > LEAST_FOLDED]


def _next_states(
    counting: CountingState, following: CountingState, states: Sequence[State], steps: EdgeTargets
) -> dict[int, int] | None:
    """Map each state in the counting state ``following`` to the next state of its run.

    ``counting`` is the counting state before ``following``. If further runs begin at the same place
    as ``following``, the map also has their first states. Return None if the two counting states do
    not belong to parallel runs.
    """
    successors: dict[int, int] = {}
    for state, after in zip(counting, following, strict=True):
        current, next_ = states[state], states[after]
        agree = (current.verdict, current.accepting) == (next_.verdict, next_.accepting)
        if not agree or steps[state].keys() != steps[after].keys() or after not in steps[state].values():
            return None
        for label, target in steps[state].items():
            target_after = steps[after][label]
            if target != target_after and successors.setdefault(target, target_after) != target_after:
                return None
    return successors if successors.keys() >= set(following) else None
