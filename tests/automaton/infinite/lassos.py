"""Random formulas, and traces that end in a cycle; a sample is the set of the names of its atoms."""

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
    """Return ``count`` random formulas of up to ``largest`` operators and atoms; a seed repeats them."""
    random = Random(seed)
    unary = (f.not_, f.next_, f.weak_next, f.eventually, f.always)
    binary = (f.until, f.weak_until, f.release, f.strong_release, f.and_, f.or_, f.implies, f.iff)

    def random_formula(size: int) -> Formula:
        if size <= 1:
            literal = f.atom(random.choice(atoms))
            return literal if random.random() < 0.7 else f.not_(literal)
        place = random.randrange(len(unary) + len(binary))
        if size == 2 or place < len(unary):
            return unary[place % len(unary)](random_formula(size - 1))
        left = random.randint(1, size - 2)
        return binary[place - len(unary)](random_formula(left), random_formula(size - 1 - left))

    return [random_formula(random.randint(2, largest)) for _ in range(count)]


def lasso(text: str) -> Lasso:
    """Parse a lasso such as ``"a ab | - b"``: prefix and cycle; a letter is an atom, ``-`` an empty sample."""
    prefix, cycle = (tuple(frozenset(part.strip("-")) for part in half.split()) for half in text.split("|"))
    return prefix, cycle


def lassos(atoms: Sequence[str] = ABC, longest: int = 3) -> st.SearchStrategy[Lasso]:
    """Lassos whose prefix and cycle each have at most ``longest`` samples."""
    sample = st.frozensets(st.sampled_from(list(atoms)))
    prefix = st.lists(sample, max_size=longest).map(tuple)
    cycle = st.lists(sample, min_size=1, max_size=longest).map(tuple)
    return st.tuples(prefix, cycle)


def some_lassos(atoms: Sequence[str], count: int, seed: int) -> list[Lasso]:
    """Return ``count`` random lassos; the prefix and the cycle have up to three samples; a seed repeats them."""
    random = Random(seed)

    def samples(least: int) -> tuple[Sample, ...]:
        length = random.randint(least, 3)
        return tuple(frozenset(atom for atom in atoms if random.random() < 0.5) for _ in range(length))

    return [(samples(0), samples(1)) for _ in range(count)]


def make_exclusive(word: Lasso, exclusive: Sequence[Sequence[str]]) -> Lasso:
    """Return the lasso that keeps, in every sample, only the first true atom of each group."""

    def first_of_each_group(sample: Sample) -> Sample:
        for group in exclusive:
            sample -= frozenset([atom for atom in group if atom in sample][1:])
        return sample

    prefix, cycle = word
    return tuple(map(first_of_each_group, prefix)), tuple(map(first_of_each_group, cycle))


def accepts(automaton: Rabin, atoms: Sequence[str], word: Lasso, state: int = 0) -> bool:
    """Whether the automaton, whose letters assign ``atoms``, accepts a lasso from ``state``."""
    prefix, cycle = ([[atom in sample for atom in atoms] for sample in part] for part in word)
    for letter in prefix:
        state, _ = automaton.step(state, letter)
    return accepts_cycle(automaton, state, cycle)


def accepts_cycle(automaton: Rabin, state: int, cycle: Sequence[Sequence[bool]]) -> bool:
    """Whether the automaton accepts, from ``state``, the trace that repeats ``cycle`` forever."""
    first_rounds: dict[int, int] = {}
    rounds: list[set[Mark]] = []
    while state not in first_rounds:
        first_rounds[state] = len(rounds)
        marks: set[Mark] = set()
        for letter in cycle:
            state, step_marks = automaton.step(state, letter)
            marks |= step_marks
        rounds.append(marks)
    recurring = set().union(*rounds[first_rounds[state] :])
    return any((pair, "fin") not in recurring and (pair, "inf") in recurring for pair in range(automaton.pairs))
