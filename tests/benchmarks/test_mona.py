"""Formulas as MONA programs, and the sizes of MONA's automata, counted as ours."""

from __future__ import annotations

import pytest

from benchmarks import mona
from tests.reference_formulas import corpus, read_formula
from tests.waiting import HANG_S

ALWAYS = """
DFA for formula with free variables: A0
Initial state: 0
Accepting states: 3
Rejecting states: 0 1 2

Automaton has 4 states and 4 BDD-nodes
Transitions:
State 0: X -> state 1
State 1: 0 -> state 2
State 1: 1 -> state 3
State 2: X -> state 2
State 3: 0 -> state 2
State 3: 1 -> state 3
"""


def test_a_formula_becomes_a_program() -> None:
    text = mona.program(read_formula("a & (b U X a)"))
    assert text == (
        "m2l-str;\nvar2 A0, A1;\n"
        "ex1 o: o = 0 & (o in A0 & (ex1 t1: o <= t1 & (t1 < max($) & (ex1 t3: t3 = t1 + 1 & t3 in A0))"
        " & (all1 t2: o <= t2 & t2 < t1 => t2 in A1)));\n"
    )


def test_a_program_without_atoms_declares_none() -> None:
    assert mona.program(read_formula("X true")).startswith("m2l-str;\nex1 o")


def test_the_initial_state_is_merged_if_possible() -> None:
    assert mona.size(ALWAYS) == 2  # G a
    unlike = ALWAYS.replace("State 1: 1 -> state 3", "State 1: 1 -> state 2")
    reached_again = ALWAYS.replace("State 2: X -> state 2", "State 2: X -> state 1")
    assert mona.size(unlike) == mona.size(reached_again) == 3


def test_outputs_without_a_normal_automaton_have_the_right_size() -> None:
    assert mona.size("Formula is unsatisfiable\n") == 1
    assert mona.size("Out of memory\n") is None


@pytest.mark.skipif(not mona.available(), reason="MONA is not installed")
@pytest.mark.parametrize("family", ["seq_noX", "declare", "edge", "branch", "until_right"])
def test_sizes_match_the_corpus(family: str) -> None:
    small = [entry for entry in corpus() if entry.family == family and (entry.states or 99) < 12]
    assert small
    for entry in small:
        result, states = mona.solve(entry.formula, timeout_s=HANG_S)
        assert (entry.name, states) == (entry.name, entry.states)
        assert result.cpu_ms > 0


@pytest.mark.skipif(not mona.available(), reason="MONA is not installed")
def test_a_run_that_is_stopped_has_no_size() -> None:
    formula = " & ".join(f"(F a{number} | G b{number})" for number in range(9))
    result, states = mona.solve(read_formula(formula), timeout_s=0.3)
    assert result.timed_out
    assert states is None
