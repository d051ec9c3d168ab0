"""Find the states of an automaton that have the same language."""

from __future__ import annotations

from collections.abc import Sequence
from random import Random
from typing import Final

from tltlc.automaton.infinite.automaton import NO_MARKS, PairMarks, Rabin
from tltlc.automaton.infinite.products import PairLeaf, StatePair, conditions, product_leaves, separating_component
from tltlc.automaton.work import Work

_WORDS: Final = 48
"""The number of random cycles on which states are compared first, before the exact comparison."""


def equal_states(automaton: Rabin, atoms: int, exclusive: Sequence[Sequence[int]], work: Work) -> list[int]:
    """Return, for each state, the first state that accepts the same traces.

    ``atoms`` is the number of atoms. ``exclusive`` has groups of indices of atoms; at most one atom
    of a group holds at a sample. Raises OutOfWork.
    """
    representatives: list[int] = []
    signatures = _signatures(automaton, atoms, exclusive, work)
    groups: dict[tuple[bool, ...], list[int]] = {}
    for state, signature in enumerate(signatures):
        group = groups.setdefault(signature, [])
        same = next((other for other in group if _equal(automaton, state, other, work)), None)
        if same is None:
            group.append(state)
        representatives.append(state if same is None else same)
    return representatives


def _equal(automaton: Rabin, one: int, other: int, work: Work) -> bool:
    """Whether two states accept the same traces. Raises OutOfWork."""
    steps, pairs = automaton.steps, automaton.pairs
    together = product_leaves(automaton.letters, pairs, lambda leaf: leaf is None)

    def leaves(both: StatePair) -> list[PairLeaf]:
        successors = together(steps[both[0]], steps[both[1]])
        work.spend(5 + len(successors))
        # From two equal states, no trace can be accepted by only one: do not explore further.
        return [leaf for leaf in successors if leaf[0][0] != leaf[0][1]]

    of_one, of_other = conditions(pairs, pairs)
    return separating_component([(one, other)], leaves, [(of_one, of_other), (of_other, of_one)], work) is None


def _signatures(automaton: Rabin, atoms: int, exclusive: Sequence[Sequence[int]], work: Work) -> list[tuple[bool, ...]]:
    """Draw random cycles of letters; return, for each state, whether it accepts each cycle repeated for ever.

    The cycles are always the same for equal arguments. Raises OutOfWork.
    """
    # A fixed seed, so that the same formula gives the same automaton.
    rng = Random(1)

    def letter() -> list[bool]:
        values = [rng.random() < 0.5 for _ in range(atoms)]
        for group in exclusive:
            for atom in [atom for atom in group if values[atom]][1:]:
                values[atom] = False
        return values

    words = [[letter() for _ in range(rng.randint(1, 3))] for _ in range(_WORDS)]
    return list(zip(*(accepting(automaton, word, work) for word in words), strict=True))


def accepting(automaton: Rabin, cycle: Sequence[Sequence[bool]], work: Work) -> list[bool]:
    """Return, for each state, whether it accepts the trace that repeats ``cycle`` for ever.

    A letter of the cycle has a truth value for each atom. Raises OutOfWork.
    """
    work.spend(len(automaton.steps))
    rounds = [_round(automaton, state, cycle) for state in range(len(automaton.steps))]
    answers: list[bool | None] = [None] * len(rounds)
    for state in range(len(rounds)):
        # The states after each round of the cycle, until one comes again or its result is known.
        visited: dict[int, None] = {}
        while answers[state] is None and state not in visited:
            visited[state] = None
            state, _ = rounds[state]
        accepted = answers[state]
        if accepted is None:
            path = list(visited)
            repeated = set().union(*(rounds[place][1] for place in path[path.index(state) :]))
            pairs = range(automaton.pairs)
            accepted = any((pair, "fin") not in repeated and (pair, "inf") in repeated for pair in pairs)
        for place in visited:
            answers[place] = accepted
    return [bool(answer) for answer in answers]


def _round(automaton: Rabin, state: int, cycle: Sequence[Sequence[bool]]) -> tuple[int, PairMarks]:
    """Return the state after one round of a cycle of letters, and all marks of the edges taken."""
    marks = NO_MARKS
    for letter in cycle:
        state, letter_marks = automaton.step(state, letter)
        marks |= letter_marks
    return state, marks
