"""The automata of the reference corpus have the sizes on which two other tools agree."""

from __future__ import annotations

import pytest

from tests.reference_formulas import Entry, corpus
from tltlc.automaton.finite.build import build, minimal_machine, spec_from_formula, state_leaves

CORPUS = list(corpus())
SMALL = [entry for entry in CORPUS if entry.states is not None and entry.states <= 40]


def test_the_corpus_is_complete() -> None:
    assert len(CORPUS) == 223
    assert len({entry.family for entry in CORPUS}) == 22


@pytest.mark.parametrize("entry", [e for e in CORPUS if e.states is not None], ids=lambda entry: entry.name)
def test_the_minimal_automaton_has_the_size_of_the_corpus(entry: Entry) -> None:
    successors, machine, _ = minimal_machine(entry.formula, entry.formula.atoms(), 50_000)
    assert len(state_leaves(machine, successors.diagrams)) == entry.states
    if entry.transition_based_states is not None:
        assert len(machine.transitions) == entry.transition_based_states


@pytest.mark.parametrize("entry", SMALL, ids=lambda entry: entry.name)
def test_the_built_automaton_has_the_size_of_the_corpus(entry: Entry) -> None:
    fspa = build(spec_from_formula(entry.formula))
    assert len(fspa.states) == entry.states
    assert {edge.source for edge in fspa.edges} == {state.id for state in fspa.states}
