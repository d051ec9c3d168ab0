"""Which states of an automaton have the same language."""

from __future__ import annotations

from collections.abc import Sequence
from random import Random
from typing import Final

from tltlc.rabin.automaton import PairMarks, Rabin
from tltlc.rabin.cycles import Edge, Edges, marks_of, parts
from tltlc.rabin.graphs import components
from tltlc.rabin.skeleton import Clause, Marks
from tltlc.rabin.work import Work

_WORDS: Final = 48
"""Lassos by which states are told apart before they are compared."""


def equal_states(automaton: Rabin, atoms: int, exclusive: Sequence[Sequence[int]], work: Work) -> list[int]:
    """Of each state the first one that has its language; letters are of so many ``atoms``, of which at most one of a
    group of ``exclusive`` holds.  Raises OutOfWork.
    """
    found: list[int] = []
    signatures = _signatures(automaton, atoms, exclusive)
    groups: dict[tuple[bool, ...], list[int]] = {}
    for state, signature in enumerate(signatures):
        group = groups.setdefault(signature, [])
        same = next((other for other in group if equal(automaton, state, other, work)), None)
        if same is None:
            group.append(state)
        found.append(state if same is None else same)
    return found


def equal(automaton: Rabin, one: int, other: int, work: Work) -> bool:
    """Whether two states have the same language: no cycle of their product is accepted by one and not by the other.

    Raises OutOfWork.
    """
    letters = automaton.letters
    memo: dict[tuple[int, int], int] = {}
    steps: dict[tuple[int, int], int] = {}

    right_from = 2 * automaton.pairs  # The first mark of the right one.

    def together(
        left: tuple[int, PairMarks] | None, right: tuple[int, PairMarks] | None
    ) -> tuple[tuple[int, int], Marks] | None:
        # Letters that there are not are so for both.
        if left is None or right is None:
            return None
        marks = {2 * pair + (kind == "inf") for pair, kind in left[1]}
        marks |= {right_from + 2 * pair + (kind == "inf") for pair, kind in right[1]}
        return (left[0], right[0]), frozenset(marks)

    def step(state: tuple[int, int]) -> list[tuple[tuple[int, int], Marks]]:
        if state not in steps:
            steps[state] = letters.combined(together, automaton.steps[state[0]], automaton.steps[state[1]], memo)
            work.spend(5)
        return [leaf for leaf in letters.values(steps[state]) if leaf is not None]

    left, right = (
        [Clause(frozenset((at + 2 * pair,)), frozenset((at + 2 * pair + 1,))) for pair in range(automaton.pairs)]
        for at in (0, right_from)
    )

    def following(state: tuple[int, int]) -> list[tuple[int, int]]:
        # Where both are the same state, no word tells them apart.
        return [target for target, _ in step(state) if target[0] != target[1]]

    for group in components([(one, other)], following):
        members = set(group)
        edges = [(state, target, marks) for state in group for target, marks in step(state) if target in members]
        if edges and (only_here(edges, left, right, work) or only_here(edges, right, left, work)):
            return False
    return True


def only_here(edges: Sequence[Edge], these: Sequence[Clause], those: Sequence[Clause], work: Work) -> Edges | None:
    """A strongly connected set of edges that is accepted by these clauses and not by those; None where none is."""
    for clause in these:
        stack = parts((edge for edge in edges if not edge[2] & clause.fins), work)
        while stack:
            part = stack.pop()
            marks = marks_of(part)
            if not clause.infs <= marks:
                continue
            met = next((each for each in those if each.accepts(marks)), None)
            if met is None:
                return part
            for mark in met.infs:
                stack += parts((edge for edge in part if mark not in edge[2]), work)
    return None


def _signatures(automaton: Rabin, atoms: int, exclusive: Sequence[Sequence[int]]) -> list[tuple[bool, ...]]:
    """Of each state which of some random cycles it accepts."""
    chance = Random(1)

    def letter() -> list[bool]:
        found = [chance.random() < 0.5 for _ in range(atoms)]
        for group in exclusive:
            for atom in [atom for atom in group if found[atom]][1:]:
                found[atom] = False
        return found

    words = [[letter() for _ in range(chance.randint(1, 3))] for _ in range(_WORDS)]
    return [tuple(automaton.accepts_cycle(state, word) for word in words) for state in range(len(automaton.steps))]
