"""What is drawn of an automaton in which several runs count in step, as of `F[0,100] a & F[0,100] b`: a ladder.

Each rung is a row of states, one of each run; a step leads from a rung to the next one, and may lead to another run.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from tltlc.automaton.fspa import Edge, Fspa, Guard, State
from tltlc.backends.drawing.folding import LEAST_FOLDED, Drawing, marked
from tltlc.core.record import replace

Rung = tuple[int, ...]
Steps = Mapping[int, Mapping[Guard, int]]
"""Of each state the target of each guard."""


def folded_in_step(fspa: Fspa) -> Drawing:
    """The drawing with the inner rungs of each ladder folded into the first of them.

    A rung's states agree with those of the next one, each with that of its own run, in verdict, acceptance and guards;
    guards lead to the same target, or one rung further.  An inner rung is entered only from the one before it.  The
    edges of the folded rung to itself along a run lead to the last rung, as in a run that is folded alone.
    """
    fspa = marked(fspa)
    ladders = _ladders(fspa)
    runs = [run for ladder in ladders for run in zip(*ladder, strict=True)]
    first = {state: run[0] for run in runs for state in run[:-1]}
    last = {run[0]: run[-1] for run in runs}
    edges = (_drawn(edge, first, last) for edge in fspa.edges if first.get(edge.source, edge.source) == edge.source)
    return Drawing(
        tuple(state for state in fspa.states if first.get(state.id, state.id) == state.id),
        tuple(edges),
        {run[0]: tuple(fspa.states[state] for state in run[:-1]) for run in runs},
    )


def _drawn(edge: Edge, first: Mapping[int, int], last: Mapping[int, int]) -> Edge:
    """An edge from a state that is drawn: into an inner rung it leads to the first one, along a run to the last one."""
    target = first.get(edge.target, edge.target)
    return replace(edge, target=last[target] if target == edge.source and target in last else target)


def _ladders(fspa: Fspa) -> list[list[Rung]]:
    """The inner rungs of each ladder that is long enough, and the rung behind them."""
    steps: dict[int, dict[Guard, int]] = {state.id: {} for state in fspa.states}
    entering: list[set[int]] = [set() for _ in fspa.states]
    for edge in fspa.edges:
        steps[edge.source][edge.guard] = edge.target
        entering[edge.target].add(edge.source)
    found: list[list[Rung]] = []
    taken: set[int] = set()
    for edge in fspa.edges:
        if not taken & {edge.source, edge.target}:
            for ladder in _from((edge.source,), (edge.target,), fspa.states, steps, entering):
                if taken.isdisjoint(state for rung in ladder for state in rung):
                    found.append(ladder)
                    taken.update(state for rung in ladder[:-1] for state in rung)
    return found


def _from(
    rung: Rung, following: Rung, states: Sequence[State], steps: Steps, entering: Sequence[set[int]]
) -> list[list[Rung]]:
    """The ladders on a way that begins with two rungs, in order; the way ends where rungs do not agree."""
    found: list[list[Rung]] = []
    ladder: list[Rung] = []
    seen = set(rung)
    while pairs := _onward(rung, following, states, steps):
        is_entered = any(not state or not entering[state] <= set(rung) for state in pairs)
        if is_entered or not seen.isdisjoint(pairs) or len(set(pairs.values())) < len(pairs):
            break
        if ladder and len(pairs) != len(rung):
            found.append(ladder)
            ladder = []
        rung = following if len(pairs) == len(following) else tuple(pairs)
        following = tuple(pairs[state] for state in rung)
        seen.update(rung)
        ladder.append(rung)
    return [each for each in (*found, ladder) if len(each) > LEAST_FOLDED]


def _onward(rung: Rung, following: Rung, states: Sequence[State], steps: Steps) -> dict[int, int] | None:
    """Of each state of the following rung, the one after it in its run; None where the two rungs do not agree."""
    found: dict[int, int] = {}
    for state, after in zip(rung, following, strict=True):
        one, other = states[state], states[after]
        agree = (one.verdict, one.accepting) == (other.verdict, other.accepting)
        if not agree or steps[state].keys() != steps[after].keys() or after not in steps[state].values():
            return None
        for guard, target in steps[state].items():
            beyond = steps[after][guard]
            if target != beyond and found.setdefault(target, beyond) != beyond:
                return None
    return found if found.keys() >= set(following) else None
