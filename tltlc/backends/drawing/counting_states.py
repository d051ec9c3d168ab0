"""Fold several runs of states that count at the same time, as in `F[0,100] a & F[0,100] b`.

A run is a path of states that differ only in a count. Several runs that count together are parallel:
their counting state n has the n-th state of each run. The inner counting states are all except the
first and the last one. An edge from a counting state leads to the next one, in the same run or in
another one, or out of the parallel runs.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from tltlc.automaton.fspa import Fspa, State
from tltlc.backends.drawing.folding import LEAST_FOLDED, Drawing, DrawnEdge, EdgeLabel, whole_drawing
from tltlc.core.record import replace

CountingState = tuple[int, ...]
"""The states of parallel runs that have the same place in their runs: one state of each run."""
EdgeTargets = Mapping[int, Mapping[EdgeLabel, int]]
"""For each state and each label of an edge that leaves it, the target of the edge."""


def fold_parallel_runs(fspa: Fspa) -> Drawing:
    """Return the drawing with the inner counting states of parallel runs folded into the first of them.

    In parallel runs, this holds for any two states that follow each other in a run:

    - They have the same verdict, the same acceptance and the same labels of edges.
    - Their edges with the same label lead to one state, or to two states that follow each other in
      a run.
    - If the second is in an inner counting state, only edges from the counting state before lead to
      it.

    An edge along a run would lead from the folded counting state to itself. It is drawn to the last
    one instead.
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
    """Return an edge with its target replaced by a state that is drawn.

    A target in an inner counting state is replaced by the state of its run in the first inner one.
    If the edge then leads from this state to itself, it is redirected to the last state of the run.
    ``first`` maps each inner state of a run to the first inner state of the run, and ``last`` maps
    the first inner state to the last state.
    """
    target = first.get(edge.target, edge.target)
    return replace(edge, target=last[target] if target == edge.source and target in last else target)


def _paths(states: Sequence[State], edges: Sequence[DrawnEdge]) -> list[list[CountingState]]:
    """Return, for each group of parallel runs that is folded, the path of its counting states.

    The path has the inner counting states and the one after them.
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
    """Return the paths of counting states that begin with ``counting`` and ``following``, in order.

    A path ends at a counting state whose states do not continue the runs. Where the number of runs
    changes, a new path begins.
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
    """Map each state of the counting state ``following`` to the next state of its run.

    ``counting`` is the counting state before ``following``. The map also has the first states of
    runs that begin at ``following``. Returns None if the two counting states do not belong to
    parallel runs.
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
