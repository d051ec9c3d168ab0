"""Find smaller automata for a component, by merging states.

A state of a component is a label and the memories of the formula's parts. A *factor* of the
component merges all states with the same key, such as the label and one of the memories. So an
edge of the factor replaces several edges of the component.

The factor must accept the same runs as the component. For this, its edges get ranks, in rounds:

- Round 0: an edge gets rank 0 if none of the edges that it replaces lies on a rejected cycle.
- Round 1, for edges without a rank: an edge gets rank 1 if none of the edges that it replaces lies
  on an accepted cycle.
- Later even rounds are like round 0, later odd rounds like round 1, for the edges that are left.

If every edge gets a rank, a run is accepted if the least rank that it takes infinitely often is
even.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

from tltlc.automaton.diagrams import Diagrams
from tltlc.automaton.fspa import Mark
from tltlc.automaton.infinite.automaton import NO_MARKS, PairMarks
from tltlc.automaton.infinite.component import ComponentAutomaton, ComponentLeaf, ComponentState
from tltlc.automaton.infinite.cycles import accepting_parts, parts, rejecting_parts
from tltlc.automaton.infinite.mark_conditions import Marks
from tltlc.automaton.infinite.pairs import RabinComponent
from tltlc.automaton.work import Work

_MOST_TOGETHER: Final = 48
"""The most states of a component that a factor may merge into one."""

_RankedEdge = tuple[ComponentState, ComponentState, Marks, int]
"""An edge of the component (source, target, marks), and the number of the factor's edge that replaces it."""


def factor(
    letters: Diagrams[Any], component: ComponentAutomaton, key: Callable[[ComponentState], ComponentState], work: Work
) -> RabinComponent | None:
    """Return the component with all states of the same key merged into one state.

    The key after a letter must depend only on the letter and on the key before the letter. Returns
    None if the merged automaton would not accept the same runs (some edge gets no rank, as the
    module describes), or if more than :data:`_MOST_TOGETHER` states have the same key. Raises
    OutOfWork.
    """
    groups: dict[ComponentState, list[ComponentState]] = {}
    for state in component.steps:
        groups.setdefault(key(state), []).append(state)
    if max(map(len, groups.values())) > _MOST_TOGETHER:
        return None
    together: dict[ComponentState, int] = {}
    classes: dict[tuple[ComponentState, tuple[ComponentLeaf, ...]], int] = {}
    edges: list[_RankedEdge] = []
    for name, states in groups.items():
        step = letters.leaf(())
        for state in states:
            step = letters.apply(lambda all_, leaf: (*all_, leaf), step, component.steps[state], {})
        together[name] = step
        for leaves in letters.values(step):
            number = classes.setdefault((name, leaves), len(classes))
            for state, (target, marks) in zip(states, leaves, strict=True):
                if target[0] != "exit":
                    edges.append((state, target, marks, number))
                work.spend()
    ranks = _ranks(edges, component, work)
    if ranks is None:
        return None
    accepting = sorted({rank for rank in ranks.values() if rank % 2 == 0})

    def marks_of(rank: int | None) -> PairMarks:
        marks: set[Mark] = {(pair, "inf") for pair, level in enumerate(accepting) if level == rank}
        if rank is not None and rank % 2:
            marks |= {(pair, "fin") for pair, level in enumerate(accepting) if level > rank}
        return frozenset(marks)

    steps = {}
    for name, step in together.items():

        def change(leaves: tuple[ComponentLeaf, ...], name: ComponentState = name) -> tuple[ComponentState, PairMarks]:
            target = leaves[0][0]
            if target[0] == "exit":
                return target, NO_MARKS
            return key(target), marks_of(ranks.get(classes[name, leaves]))

        steps[name] = letters.map_leaves(change, step, {})
    return RabinComponent({name: component.labels[states[0]] for name, states in groups.items()}, steps, len(accepting))


def _ranks(edges: list[_RankedEdge], component: ComponentAutomaton, work: Work) -> dict[int, int] | None:
    """Return the rank of each edge of the merged automaton; None if some edge gets no rank.

    A run of the merged automaton is accepted if the least rank that it takes infinitely often is
    even.
    """
    # The functions of `cycles` read three fields of an edge; the number only keeps the edges distinct.
    unranked: frozenset[Any] = frozenset(edges)
    ranks: dict[int, int] = {}
    rank = 0
    stuck = 0
    while unranked:
        cycles = parts(unranked, work)
        if not cycles:
            return {**ranks, **{edge[3]: rank | 1 for edge in unranked}}
        bad: set[int] = set()
        inside: Callable[..., list[frozenset[Any]]] = rejecting_parts if rank % 2 == 0 else accepting_parts
        for cycle in cycles:
            for part in inside(cycle, component.accepts, work):
                bad |= {edge[3] for edge in part}
        here = {edge[3] for edge in unranked} - bad
        stuck = 0 if here else stuck + 1
        if stuck == 2:
            return None
        ranks.update(dict.fromkeys(here, rank))
        unranked = frozenset(edge for edge in unranked if edge[3] not in here)
        rank += 1
    return ranks
