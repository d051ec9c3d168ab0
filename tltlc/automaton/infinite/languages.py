"""Which states of an automaton have the same language."""

from __future__ import annotations

from collections.abc import Sequence
from random import Random
from typing import Final

from tltlc.automaton.infinite.automaton import NO_MARKS, PairMarks, Rabin
from tltlc.automaton.infinite.products import Both, Leaf, conditions, side_by_side, telling_apart
from tltlc.automaton.infinite.work import Work

_WORDS: Final = 48
"""Cycles by which states are told apart before they are compared."""


def equal_states(automaton: Rabin, atoms: int, exclusive: Sequence[Sequence[int]], work: Work) -> list[int]:
    """Of each state the first one that has its language; letters are of so many ``atoms``, of which at most one of a
    group of ``exclusive`` holds.  Raises OutOfWork.
    """
    found: list[int] = []
    signatures = _signatures(automaton, atoms, exclusive, work)
    groups: dict[tuple[bool, ...], list[int]] = {}
    for state, signature in enumerate(signatures):
        group = groups.setdefault(signature, [])
        same = next((other for other in group if _equal(automaton, state, other, work)), None)
        if same is None:
            group.append(state)
        found.append(state if same is None else same)
    return found


def _equal(automaton: Rabin, one: int, other: int, work: Work) -> bool:
    """Whether two states have the same language: no cycle of their product is accepted by one and not by the other.

    Raises OutOfWork.
    """
    steps, pairs = automaton.steps, automaton.pairs
    together = side_by_side(automaton.letters, pairs, lambda leaf: leaf is None)

    def leaves(both: Both) -> list[Leaf]:
        found = together(steps[both[0]], steps[both[1]])
        work.spend(5 + len(found))
        # Where both are the same state, no word tells them apart.
        return [leaf for leaf in found if leaf[0][0] != leaf[0][1]]

    these, those = conditions(pairs, pairs)
    return telling_apart([(one, other)], leaves, [(these, those), (those, these)], work) is None


def _signatures(automaton: Rabin, atoms: int, exclusive: Sequence[Sequence[int]], work: Work) -> list[tuple[bool, ...]]:
    """Of each state which of some random cycles it accepts.  Raises OutOfWork."""
    # Always the same ones, so that the same formula gives the same automaton.
    chance = Random(1)

    def letter() -> list[bool]:
        found = [chance.random() < 0.5 for _ in range(atoms)]
        for group in exclusive:
            for atom in [atom for atom in group if found[atom]][1:]:
                found[atom] = False
        return found

    words = [[letter() for _ in range(chance.randint(1, 3))] for _ in range(_WORDS)]
    return list(zip(*(accepting(automaton, word, work) for word in words), strict=True))


def accepting(automaton: Rabin, cycle: Sequence[Sequence[bool]], work: Work) -> list[bool]:
    """Of each state whether it accepts the trace that goes round a cycle of letters for ever.  Raises OutOfWork."""
    work.spend(len(automaton.steps))
    rounds = [_round(automaton, state, cycle) for state in range(len(automaton.steps))]
    found: list[bool | None] = [None] * len(rounds)
    for state in range(len(rounds)):
        # The states after each round, up to one that is settled or that comes again.
        met: dict[int, None] = {}
        while found[state] is None and state not in met:
            met[state] = None
            state, _ = rounds[state]
        accepted = found[state]
        if accepted is None:
            way = list(met)
            for_ever = set().union(*(rounds[each][1] for each in way[way.index(state) :]))
            pairs = range(automaton.pairs)
            accepted = any((pair, "fin") not in for_ever and (pair, "inf") in for_ever for pair in pairs)
        for each in met:
            found[each] = accepted
    return [bool(each) for each in found]


def _round(automaton: Rabin, state: int, cycle: Sequence[Sequence[bool]]) -> tuple[int, PairMarks]:
    """The state after one round of a cycle of letters, and its marks."""
    marks = NO_MARKS
    for letter in cycle:
        state, said = automaton.step(state, letter)
        marks |= said
    return state, marks
