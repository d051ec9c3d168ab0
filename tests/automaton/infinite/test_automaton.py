"""The automaton of a formula: its language (on lassos, and exactly), its form, and its work budget."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.automaton.infinite.lassos import ABC, accepts, make_exclusive, some_formulas, some_lassos
from tests.automaton.infinite.products import equal, letters, opposite
from tests.reference_formulas import read_formula
from tltlc.automaton.finite.blowup import recursion_room
from tltlc.automaton.infinite.automaton import Rabin
from tltlc.automaton.infinite.construct import rabin
from tltlc.automaton.infinite.lasso import holds_on_lasso
from tltlc.automaton.work import OutOfWork
from tltlc.logic.formula import Formula, not_

Groups = tuple[tuple[str, ...], ...]
SEEDS = pytest.mark.parametrize("seed", range(10))
GROUPS = [(("a", "b"),), (("a", "b", "c"),), (("a", "b"), ("b", "c"))]
WORK = 300_000
"""Formulas that need more steps are skipped, to save time."""


def automaton_of(formula: Formula, exclusive: Groups = ()) -> Rabin:
    """Return the automaton of a formula over the atoms a, b and c."""
    with recursion_room():
        return rabin(formula, ABC, places(exclusive), WORK)


def places(exclusive: Groups) -> list[list[int]]:
    """Return groups as the indices of their atoms."""
    return [[ABC.index(atom) for atom in group] for group in exclusive]


def random_automata(count: int, largest: int, seed: int, exclusive: Groups = ()) -> Iterator[tuple[Formula, Rabin]]:
    """Yield ``count`` random formulas with their automata, except up to two that need too much work."""
    left_out = 0
    for formula in some_formulas(count, largest, seed):
        try:
            yield formula, automaton_of(formula, exclusive)
        except OutOfWork:
            left_out += 1
    assert left_out <= 2


# --- the language ---------------------------------------------------------------------------------


@SEEDS
def test_accepts_the_lassos_on_which_the_formula_holds(seed: int) -> None:
    words = some_lassos(ABC, 20, seed)
    for formula, automaton in random_automata(60, 10, seed):
        for word in words:
            assert accepts(automaton, ABC, word) == holds_on_lasso(formula, *word), (formula, word)


@SEEDS
def test_accepts_the_right_lassos_with_exclusive_atoms(seed: int) -> None:
    groups = GROUPS[seed % len(GROUPS)]
    words = [make_exclusive(word, groups) for word in some_lassos(ABC, 20, seed)]
    for formula, automaton in random_automata(30, 10, seed, groups):
        for word in words:
            assert accepts(automaton, ABC, word) == holds_on_lasso(formula, *word), (formula, word)


@SEEDS
def test_a_formula_or_its_negation_accepts_each_word(seed: int) -> None:
    for formula, automaton in random_automata(20, 9, seed):
        assert opposite(automaton, automaton_of(not_(formula)), letters(3)), formula


@SEEDS
def test_exclusive_atoms_change_nothing_on_possible_words(seed: int) -> None:
    groups = GROUPS[seed % len(GROUPS)]
    for formula, automaton in random_automata(20, 8, seed):
        assert equal(automaton_of(formula, groups), automaton, letters(3, places(groups))), formula


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ("G F a & G F b", "G F(a & F b)"),
        ("F G a | F G b", "!(G F !a & G F !b)"),
        ("G(a -> F b)", "!F(a & G !b)"),
        ("a R b", "(b W (a & b))"),
        ("G F a -> G F b", "F G !a | G F b"),
        ("G(a | X G b) & F G c", "(G a | a U X G b) & F G c"),
    ],
)
def test_automata_of_equal_formulas_accept_the_same_words(one: str, other: str) -> None:
    left, right = (rabin(read_formula(text), ABC) for text in (one, other))
    assert equal(left, right, letters(3))
    assert not opposite(left, right, letters(3))


def test_a_pair_of_obligations_differs_from_a_pair_of_truth_values() -> None:
    """The obligations (1, 0) and the pair (True, False) once shared a leaf, and the construction failed."""
    formula = read_formula("G X F F(!c & X !c R (c | X !b))")
    automaton = automaton_of(formula)
    for word in some_lassos(ABC, 50, 0):
        assert accepts(automaton, ABC, word) == holds_on_lasso(formula, *word)


def test_the_comparison_of_this_test_distinguishes_languages() -> None:
    left, right = (rabin(read_formula(text), ABC) for text in ("G F a", "F G a"))
    assert not equal(left, right, letters(3))
    assert not opposite(left, right, letters(3))


# --- the form -------------------------------------------------------------------------------------


@pytest.mark.parametrize("exclusive", [(), *GROUPS])
def test_automata_are_deterministic_complete_and_reachable(exclusive: Groups) -> None:
    possible = set(letters(3, places(exclusive)))
    for _, automaton in random_automata(40, 9, 1, exclusive):
        states = range(len(automaton.steps))
        for state in states:
            for letter in letters(3):
                leaf = automaton.letters.at(automaton.steps[state], letter.__getitem__)
                assert (leaf is None) == (letter not in possible)
                if leaf is not None:
                    target, marks = leaf
                    assert target in states
                    assert all(0 <= pair < automaton.pairs and kind in ("fin", "inf") for pair, kind in marks)
        reached = [0]
        for state in reached:
            reached += dict.fromkeys(target for target, _ in automaton.leaves(state) if target not in reached)
        assert sorted(reached) == list(states)


def test_a_state_accepts_the_lassos_on_which_its_label_holds() -> None:
    words = some_lassos(ABC, 12, 0)
    for _, automaton in random_automata(100, 9, 2):
        for state, label in enumerate(automaton.labels):
            for word in words:
                assert accepts(automaton, ABC, word, state) == holds_on_lasso(label, *word), (
                    automaton.labels[0],
                    label,
                )


@pytest.mark.parametrize(
    ("text", "states", "pairs"),
    [
        ("true", 1, 1),
        ("G F a", 1, 1),
        ("F G a", 1, 1),
        ("G F a & G F b", 2, 1),
        ("G F a | G F b", 1, 1),
        ("G F a -> G F b", 1, 2),
        ("(G F a & F G b) | (G F c & F G d)", 1, 2),
        ("F a & G b", 3, 1),
        ("F(a & X F(b & X F c)) & G d", 5, 1),
        ("G(a -> F b)", 2, 1),
        ("F((a | X X b) & G c)", 4, 1),
        ("F G(a | X X b) | F G(c | X X d)", 8, 1),
    ],
)
def test_automata_of_simple_formulas_have_these_sizes(text: str, states: int, pairs: int) -> None:
    automaton = rabin(read_formula(text))
    assert (len(automaton.steps), automaton.pairs) == (states, pairs)


def test_conditions_that_are_rabin_pairs_need_one_state() -> None:
    pairs = [f"(F G a{i} & G F b{i})" for i in range(4)]
    automaton = rabin(read_formula(" | ".join(pairs)))
    assert (len(automaton.steps), automaton.pairs) == (1, 4)


# --- work -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("text", ["G(a -> X X X X X X X X X X X X b)", "G F a & G F b", "a U (b U (c U a))"])
def test_a_construction_stops_when_its_work_is_used_up(text: str) -> None:
    with pytest.raises(OutOfWork):
        rabin(read_formula(text), work=5)


def test_a_formula_that_is_too_large_uses_up_its_work() -> None:
    large = " & ".join(f"(G F a{i} -> G F b{i})" for i in range(8))
    with pytest.raises(OutOfWork):
        rabin(read_formula(large), work=200_000)


def test_a_larger_budget_changes_nothing() -> None:
    formula = read_formula("G(a -> F b) & F G(c | X a)")
    assert _described(rabin(formula, work=2_000_000)) == _described(rabin(formula))


def test_output_does_not_depend_on_the_hash_seed() -> None:
    program = """
import tltlc
from tests.automaton.infinite.test_automaton import SPECS, shown
from tltlc.backends import Options, json
for fspa in tltlc.compile_text(SPECS):
    print(json.emit(fspa, Options()))
for text in ["F G(a | X X b) | F G(c | X X d)", "(G F a -> G F b) & G(c U d | X b)", "G((a U b) W c)"]:
    print(shown(text))
"""
    root = Path(__file__).parents[3]
    outputs = set()
    for seed in ("0", "1"):
        environment = {**os.environ, "PYTHONHASHSEED": seed}
        result = subprocess.run(
            [sys.executable, "-c", program], env=environment, cwd=root, capture_output=True, check=True
        )
        outputs.add(result.stdout)
    (output,) = outputs
    assert output.count(b"acceptance") == 3


SPECS = """
signal a: bool
signal b: bool
signal alive: bool
spec sequence { semantics infinite  reach a then b  keep alive }
spec again { semantics infinite  require G F a }
spec fair { semantics infinite  require (G F a -> G F b) and G alive }
"""


def shown(text: str) -> str:
    """Return a complete description of the automaton of a formula."""
    return repr(_described(rabin(read_formula(text))))


def _described(automaton: Rabin) -> list[object]:
    letters_, atoms = automaton.letters, len(automaton.labels[0].atoms())
    rows: list[object] = [automaton.pairs, [str(label) for label in automaton.labels]]
    for step in automaton.steps:
        for letter in letters(atoms):
            target, marks = letters_.at(step, letter.__getitem__)
            rows.append((target, sorted(marks)))
    return rows
