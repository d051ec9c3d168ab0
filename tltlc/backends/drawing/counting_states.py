"""Fold several runs of states that count at the same time, as in `F[0,100] a & F[0,100] b`.

A run is a path of states that differ only in a count. Several runs form a ladder: its rung n has
the n-th state of each run. The inner rungs are all except the first and the last one. An edge from
a rung leads to the next rung, in the same run or in another one, or out of the ladder.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from tltlc.automaton.fspa import Fspa, State
from tltlc.backends.drawing.folding import LEAST_FOLDED, Drawing, DrawnEdge, EdgeLabel, whole_drawing
from tltlc.core.record import replace

Rung = tuple[int, ...]
Steps = Mapping[int, Mapping[EdgeLabel, int]]
"""For each state and each label of an edge that leaves it, the target of the edge."""


def fold_ladders(fspa: Fspa) -> Drawing:
    """Return the drawing with the inner rungs of each ladder folded into the first of them.

    In a ladder, this holds for any two states that follow each other in a run:

    - They have the same verdict, the same acceptance and the same labels of edges.
    - Their edges with the same label lead to one state, or to two states that follow each other in
      a run.
    - If the second is in an inner rung, only edges from the rung before lead to it.

    An edge along a run would lead from the folded rung to itself. It is drawn to the last rung
    instead.
    """
    states, all_edges = fspa.states, whole_drawing(fspa).edges
    ladders = _ladders(states, all_edges)
    runs = [run for ladder in ladders for run in zip(*ladder, strict=True)]
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

    A target in an inner rung is replaced by the state of its run in the first inner rung. If the
    edge then leads from this state to itself, it is redirected to the last state of the run.
    ``first`` maps each inner state of a run to the first inner state of the run, and ``last`` maps
    the first inner state to the last state.
    """
    target = first.get(edge.target, edge.target)
    return replace(edge, target=last[target] if target == edge.source and target in last else target)


def _ladders(states: Sequence[State], edges: Sequence[DrawnEdge]) -> list[list[Rung]]:
    """Return, for each ladder that is folded, the inner rungs and the rung after them.

    A ladder is several runs of states that count at the same time. A rung has one state of each
    run. The inner rungs are all except the first and the last one.
    """
    steps: dict[int, dict[EdgeLabel, int]] = {state.id: {} for state in states}
    entering: list[set[int]] = [set() for _ in states]
    for edge in edges:
        steps[edge.source][edge.label] = edge.target
        entering[edge.target].add(edge.source)
    ladders: list[list[Rung]] = []
    used_states: set[int] = set()
    for edge in edges:
        if not used_states & {edge.source, edge.target}:
            for ladder in _ladders_from((edge.source,), (edge.target,), states, steps, entering):
                if used_states.isdisjoint(state for rung in ladder for state in rung):
                    ladders.append(ladder)
                    used_states.update(state for rung in ladder[:-1] for state in rung)
    return ladders


def _ladders_from(
    rung: Rung, following: Rung, states: Sequence[State], steps: Steps, entering: Sequence[set[int]]
) -> list[list[Rung]]:
    """Return the ladders on the path of rungs that begins with ``rung`` and ``following``, in order.

    A ladder is several runs of states that count at the same time. A rung has one state of each
    run. The path ends at a rung whose states do not continue the runs. Where the number of runs
    changes, a new ladder begins.
    """
    ladders: list[list[Rung]] = []
    ladder: list[Rung] = []
    seen = set(rung)
    while pairs := _next_rung(rung, following, states, steps):
        is_entered = any(not state or not entering[state] <= set(rung) for state in pairs)
        if is_entered or not seen.isdisjoint(pairs) or len(set(pairs.values())) < len(pairs):
            break
        if ladder and len(pairs) != len(rung):
            ladders.append(ladder)
            ladder = []
        rung = following if len(pairs) == len(following) else tuple(pairs)
        following = tuple(pairs[state] for state in rung)
        seen.update(rung)
        ladder.append(rung)
    return [candidate for candidate in (*ladders, ladder) if len(candidate) > LEAST_FOLDED]


def _next_rung(rung: Rung, following: Rung, states: Sequence[State], steps: Steps) -> dict[int, int] | None:
    """Map each state of the rung ``following`` to the next state of its run.

    A rung has one state of each of several runs that count at the same time. The map also has the
    first states of runs that begin at ``following``. Returns None if the two rungs do not belong to
    a ladder.
    """
    successors: dict[int, int] = {}
    for state, after in zip(rung, following, strict=True):
        current, next_ = states[state], states[after]
        agree = (current.verdict, current.accepting) == (next_.verdict, next_.accepting)
        if not agree or steps[state].keys() != steps[after].keys() or after not in steps[state].values():
            return None
        for label, target in steps[state].items():
            target_after = steps[after][label]
            if target != target_after and successors.setdefault(target, target_after) != target_after:
                return None
    return successors if successors.keys() >= set(following) else None
