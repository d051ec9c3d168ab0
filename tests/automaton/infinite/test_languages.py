"""States with equal languages, which the cycles of letters that they accept tell apart."""

from __future__ import annotations

from random import Random

import pytest

from tests.automaton.infinite.lassos import ABC, accepts_cycle
from tests.automaton.infinite.test_automaton import automaton_of, random_automata
from tests.reference_formulas import read_formula
from tltlc.automaton.infinite.automaton import Rabin
from tltlc.automaton.infinite.construct import rabin
from tltlc.automaton.infinite.languages import accepting, equal_states
from tltlc.automaton.work import OutOfWork, Work


@pytest.mark.parametrize("seed", range(3))
def test_the_states_that_accept_a_cycle_match_single_runs(seed: int) -> None:
    random = Random(seed)
    for formula, automaton in random_automata(40, 10, seed):
        for _ in range(10):
            cycle = [[random.random() < 0.5 for _ in ABC] for _ in range(random.randint(1, 3))]
            expected = [accepts_cycle(automaton, state, cycle) for state in range(len(automaton.steps))]
            assert accepting(automaton, cycle, Work(1_000)) == expected, formula


class CountingAutomaton(Rabin):
    """An automaton that counts the letters it reads."""

    read = 0

    def step(self, state, letter):  # type: ignore[no-untyped-def]
        CountingAutomaton.read += 1
        return super().step(state, letter)


def test_each_state_reads_a_cycle_once() -> None:
    automaton = automaton_of(read_formula("X " * 60 + "a"))
    CountingAutomaton.read = 0
    counted = CountingAutomaton(automaton.letters, automaton.steps, automaton.labels, automaton.pairs)
    assert accepting(counted, [[True, False, False]], Work(1_000)).count(False) == 1
    assert CountingAutomaton.read == len(automaton.steps) > 60


def test_cycles_are_counted_as_work() -> None:
    with pytest.raises(OutOfWork):
        equal_states(automaton_of(read_formula("X X a")), len(ABC), (), Work(100))


def test_edges_of_products_are_counted_as_work() -> None:
    names = [f"a{number}" for number in range(8)]
    automaton = rabin(read_formula(" & ".join(f"F {name}" for name in names)), names)
    with pytest.raises(OutOfWork):
        equal_states(automaton, len(names), (), Work(25_000))
