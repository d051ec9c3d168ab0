"""Random formulas, and traces that end in a cycle; atoms of a sample are given by their names."""

from __future__ import annotations

from collections.abc import Sequence
from random import Random

from hypothesis import strategies as st

from tltlc.automaton.fspa import Mark
from tltlc.automaton.infinite.automaton import Rabin
from tltlc.logic import formula as f
from tltlc.logic.formula import Formula

Sample = frozenset[str]
Lasso = tuple[tuple[Sample, ...], tuple[Sample, ...]]
"""A prefix and a cycle."""

ABC = ("a", "b", "c")


def some_formulas(count: int, largest: int, seed: int, atoms: Sequence[str] = ABC) -> list[Formula]:
    """So many formulas of up to ``largest`` operators and atoms, the same for the same seed."""
    chance = Random(seed)
    unary = (f.not_, f.next_, f.weak_next, f.eventually, f.always)
    binary = (f.until, f.weak_until, f.release, f.strong_release, f.and_, f.or_, f.implies, f.iff)

    def grown(size: int) -> Formula:
        if size <= 1:
            literal = f.atom(chance.choice(atoms))
            return literal if chance.random() < 0.7 else f.not_(literal)
        place = chance.randrange(len(unary) + len(binary))
        if size == 2 or place < len(unary):
            return unary[place % len(unary)](grown(size - 1))
        left = chance.randint(1, size - 2)
        return binary[place - len(unary)](grown(left), grown(size - 1 - left))

    return [grown(chance.randint(2, largest)) for _ in range(count)]


def lasso(text: str) -> Lasso:
    """``"a ab | - b"``: the prefix and the cycle, a sample's atoms by their letters, ``-`` for none."""
    prefix, cycle = (tuple(frozenset(part.strip("-")) for part in half.split()) for half in text.split("|"))
    return prefix, cycle


def lassos(atoms: Sequence[str] = ABC, longest: int = 3) -> st.SearchStrategy[Lasso]:
    """Lassos whose prefix and cycle are not longer than ``longest``."""
    sample = st.frozensets(st.sampled_from(list(atoms)))
    prefix = st.lists(sample, max_size=longest).map(tuple)
    cycle = st.lists(sample, min_size=1, max_size=longest).map(tuple)
    return st.tuples(prefix, cycle)


def some_lassos(atoms: Sequence[str], count: int, seed: int) -> list[Lasso]:
    """So many lassos with up to three samples before the cycle and in it, the same for the same seed."""
    chance = Random(seed)

    def samples(least: int) -> tuple[Sample, ...]:
        length = chance.randint(least, 3)
        return tuple(frozenset(atom for atom in atoms if chance.random() < 0.5) for _ in range(length))

    return [(samples(0), samples(1)) for _ in range(count)]


def allowed(word: Lasso, exclusive: Sequence[Sequence[str]]) -> Lasso:
    """The lasso with all but the first atom of each group left out of every sample."""

    def kept(sample: Sample) -> Sample:
        for group in exclusive:
            sample -= frozenset([atom for atom in group if atom in sample][1:])
        return sample

    prefix, cycle = word
    return tuple(map(kept, prefix)), tuple(map(kept, cycle))


def accepts(automaton: Rabin, atoms: Sequence[str], word: Lasso, state: int = 0) -> bool:
    """Whether a state of the automaton, whose letters are of these atoms, accepts a lasso."""
    prefix, cycle = ([[atom in sample for atom in atoms] for sample in part] for part in word)
    for letter in prefix:
        state, _ = automaton.step(state, letter)
    return accepts_cycle(automaton, state, cycle)


def accepts_cycle(automaton: Rabin, state: int, cycle: Sequence[Sequence[bool]]) -> bool:
    """Whether a state accepts the trace that goes round a cycle of letters for ever."""
    met: dict[int, int] = {}
    rounds: list[set[Mark]] = []
    while state not in met:
        met[state] = len(rounds)
        marks: set[Mark] = set()
        for letter in cycle:
            state, said = automaton.step(state, letter)
            marks |= said
        rounds.append(marks)
    for_ever = set().union(*rounds[met[state] :])
    return any((pair, "fin") not in for_ever and (pair, "inf") in for_ever for pair in range(automaton.pairs))
