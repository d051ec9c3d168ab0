"""Fold runs that count in step, as in `F[0,100] a & F[0,100] b`; together they form a ladder.

Each rung is a row with one state of each run. A step leads from a rung to the next one, and may
lead to another run.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from tltlc.automaton.fspa import Fspa, State
from tltlc.backends.drawing.folding import LEAST_FOLDED, Drawing, DrawnEdge, EdgeLabel, whole_drawing
from tltlc.core.record import replace

Rung = tuple[int, ...]
Steps = Mapping[int, Mapping[EdgeLabel, int]]
"""Per state, the target of each label of an edge."""


def fold_ladders(fspa: Fspa) -> Drawing:
    """Return the drawing with the inner rungs of each ladder folded into the first inner rung.

    Each state of a rung agrees with the next state of its run in verdict, acceptance and the labels
    of its edges. Edges of the two states with equal labels lead to the same target, or to states of
    one run in neighbouring rungs. An inner rung is entered only from the rung before it. Edges along
    a run, which would lead from the folded rung to itself, are drawn to the last rung.
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
    """Return an edge of a drawn state with its target in the drawing.

    Edges into an inner rung lead to the first inner rung; edges along a run lead to the last rung.
    """
    target = first.get(edge.target, edge.target)
    return replace(edge, target=last[target] if target == edge.source and target in last else target)


def _ladders(states: Sequence[State], edges: Sequence[DrawnEdge]) -> list[list[Rung]]:
    """Return the inner rungs of each ladder that is long enough, and the rung after them."""
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
    """Return the ladders, in order, of the path that begins with two given rungs.

    The path ends where rungs do not agree.
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
    """Return, for each state of the following rung, the next state of its run; None if the two rungs do not agree."""
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
