"""The automata of the formulas in the table are correct on random lassos, and no larger than recorded."""

from __future__ import annotations

import pytest

from tests.automaton.infinite.lassos import accepts, some_lassos
from tests.automaton.infinite.reference import Entry, automaton_of, entries, states
from tltlc.automaton.infinite.lasso import holds_on_lasso

ENTRIES = entries()
QUICK = [entry for entry in ENTRIES if entry.steps <= 10_000]
SLOW = [entry for entry in ENTRIES if entry.steps > 10_000]
CHUNKS = 20


def test_the_table_is_complete() -> None:
    assert sum(entry.source == "owl" for entry in ENTRIES) == 785
    assert sum(entry.source == "families" for entry in ENTRIES) == 30
    assert len(QUICK) > 700


@pytest.mark.parametrize("chunk", range(CHUNKS))
def test_small_formulas_have_correct_automata_of_the_recorded_size(chunk: int) -> None:
    _check_language_and_size(QUICK[chunk::CHUNKS])


@pytest.mark.slow
def test_large_formulas_have_correct_automata_of_the_recorded_size() -> None:
    _check_language_and_size(SLOW)


def _check_language_and_size(entries_: list[Entry]) -> None:
    total = 0
    for entry in entries_:
        automaton = automaton_of(entry.formula)
        atoms = entry.formula.atoms()
        for word in some_lassos(atoms, 12, len(atoms)):
            assert accepts(automaton, atoms, word) == holds_on_lasso(entry.formula, *word), (entry.formula, word)
        total += states(automaton)
    assert total <= sum(entry.states for entry in entries_)
