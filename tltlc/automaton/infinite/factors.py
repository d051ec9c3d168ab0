"""Smaller automata of a component: by labels and few memories alone, where edges of that can say what is accepted.

An edge of a factor stands for all edges of the component that have its source, target and letter.  Where none of these
lies on a rejected cycle, a run that takes the edge for ever is accepted, and it counts first; the others are looked at
without such edges, in turn for acceptance and rejection.  If every edge finds its rank so, ranks decide as priorities.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

from tltlc.automaton.fspa import Mark
from tltlc.automaton.infinite.automaton import NO_MARKS, PairMarks
from tltlc.automaton.infinite.component import Leaf, Local, State
from tltlc.automaton.infinite.cycles import accepting_parts, parts, rejecting_parts
from tltlc.automaton.infinite.letters import Letters
from tltlc.automaton.infinite.mark_conditions import Marks
from tltlc.automaton.infinite.pairs import Piece
from tltlc.automaton.infinite.work import Work

_MOST_TOGETHER: Final = 48
"""States of a component that stand behind one of a factor."""

_Edge = tuple[State, State, Marks, int]
"""An edge of the component, and the number of the edge of the factor that stands for it."""


def factor(letters: Letters[Any], one: Local, key: Callable[[State], State], work: Work) -> Piece | None:
    """The factor of a component by a key of its states, the key after a letter depending on key and letter alone; None
    where its edges cannot say what is accepted.  Raises OutOfWork.
    """
    groups: dict[State, list[State]] = {}
    for state in one.steps:
        groups.setdefault(key(state), []).append(state)
    if max(map(len, groups.values())) > _MOST_TOGETHER:
        return None
    together: dict[State, int] = {}
    classes: dict[tuple[State, tuple[Leaf, ...]], int] = {}
    edges: list[_Edge] = []
    for name, states in groups.items():
        step = letters.leaf(())
        for state in states:
            step = letters.combined(lambda all_, leaf: (*all_, leaf), step, one.steps[state], {})
        together[name] = step
        for leaves in letters.values(step):
            number = classes.setdefault((name, leaves), len(classes))
            for state, (target, marks) in zip(states, leaves, strict=True):
                if target[0] != "exit":
                    edges.append((state, target, marks, number))
                work.spend()
    ranks = _ranks(edges, one, work)
    if ranks is None:
        return None
    accepting = sorted({rank for rank in ranks.values() if rank % 2 == 0})

    def marks_of(rank: int | None) -> PairMarks:
        said: set[Mark] = {(pair, "inf") for pair, level in enumerate(accepting) if level == rank}
        if rank is not None and rank % 2:
            said |= {(pair, "fin") for pair, level in enumerate(accepting) if level > rank}
        return frozenset(said)

    steps = {}
    for name, step in together.items():

        def change(leaves: tuple[Leaf, ...], name: State = name) -> tuple[State, PairMarks]:
            target = leaves[0][0]
            if target[0] == "exit":
                return target, NO_MARKS
            return key(target), marks_of(ranks.get(classes[name, leaves]))

        steps[name] = letters.mapped(change, step, {})
    return Piece({name: one.labels[states[0]] for name, states in groups.items()}, steps, len(accepting))


def _ranks(edges: list[_Edge], one: Local, work: Work) -> dict[int, int] | None:
    """The rank of each class of edges: even ones accept, the least that is taken for ever decides."""
    # Elsewhere edges have no number; there it is no more than what tells them apart.
    left: frozenset[Any] = frozenset(edges)
    ranks: dict[int, int] = {}
    rank = 0
    stuck = 0
    while left:
        cycles = parts(left, work)
        if not cycles:
            return {**ranks, **{edge[3]: rank | 1 for edge in left}}
        bad: set[int] = set()
        inside: Callable[..., list[frozenset[Any]]] = rejecting_parts if rank % 2 == 0 else accepting_parts
        for cycle in cycles:
            for some in inside(cycle, one.accepts, work):
                bad |= {edge[3] for edge in some}
        here = {edge[3] for edge in left} - bad
        stuck = 0 if here else stuck + 1
        if stuck == 2:
            return None
        ranks.update(dict.fromkeys(here, rank))
        left = frozenset(edge for edge in left if edge[3] not in here)
        rank += 1
    return ranks
