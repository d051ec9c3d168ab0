"""Labels over infinite traces use the operators of the source, are short, and have an English sentence."""

from __future__ import annotations

from collections import defaultdict

import pytest
from hypothesis import given, settings

from tests.automaton.infinite.lassos import ABC, some_formulas, some_lassos
from tests.automaton.infinite.reference import automaton_of, entries
from tests.automaton.infinite.runs import compiled
from tests.logic.small_formulas import formulas_of_size, formulas_up_to
from tests.logic.strategies import formulas
from tests.logic.test_english import assert_sentence
from tests.reference_formulas import read_formula
from tltlc.automaton.infinite.label_factoring import Factoring
from tltlc.automaton.infinite.lasso import holds_on_lasso
from tltlc.automaton.infinite.normal_form import infinite_form, with_derived_operators
from tltlc.automaton.infinite.readback import NormalFormWriter, without_constants
from tltlc.automaton.text import formula_text
from tltlc.logic.formula import Formula
from tltlc.logic.text.printer import ascii_text, english_text


def label_text(label: str, source: str) -> str:
    return ascii_text(NormalFormWriter(read_formula(source)).formula(infinite_form(read_formula(label))))


# --- short ----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("source", "label", "expected"),
    [
        # As in the source.
        ("F b & (F G !c | G F d)", "F b & F G !c | F b & G F d", "F b & (F G !c | G F d)"),
        ("G F a & (b -> F G c)", "G F a & !b | G F a & F G c", "G F a & (b -> F G c)"),
        ("(F a | G b) & (F b | G c)", "F a & F b | F a & G c | G b & F b | G b & G c", "(F a | G b) & (F b | G c)"),
        ("G(a <-> X b) & c", "a & b & c | !a & !b & c", "(a & b | !a & !b) & c"),
        # Shorter than the formula of the construction, or than its diagram.
        ("G(b | F d)", "b & !d | d", "b | d"),
        ("F a & G b | F d & G c", "G b | (G b | F d) & G c", "G b | F d & G c"),
        ("F a & F b & F c", "a & b | !a & c | b & c", "a & b | !a & c"),
        ("F a & F b & F c", "(a | F b) & (a | F c) & (a | d)", "a | F b & F c & d"),
        ("(a | b) & (c | d)", "a & c | a & d | b & c | b & d", "(a | b) & (c | d)"),
        ("F a & (b | c & d | G e)", "F a & b | F a & c & d | F a & G e", "F a & (b | c & d | G e)"),
        # A part that another part implies is left out.
        ("G X b & F a", "G X b & X b & b", "G X b & b"),
        ("F(a & X F b) & c", "F(a & X F b) & F b & c", "F(a & X F b) & c"),
        ("a U (b U c)", "a U (b U c) | b U c", "a U b U c"),
        # No constants remain.
        ("G((a <-> (b & X true)) | X c)", "(a & b | !a & !b) & F c", "(a & b | !a & !b) & F c"),
    ],
)
def test_a_label_is_as_short_as_the_operators_of_the_source_allow(source: str, label: str, expected: str) -> None:
    assert label_text(label, source) == expected


def test_a_label_shows_what_remains_of_each_clause() -> None:
    source = "F b & (F G !c | G F d)"
    assert {str(state.label) for state in compiled(source).states} == {source, "F G !c | G F d"}


@pytest.mark.parametrize("seed", range(8))
def test_other_forms_of_a_formula_keep_its_meaning(seed: int) -> None:
    words = some_lassos(ABC, 12, seed)
    factoring = Factoring(ABC)
    for formula in some_formulas(60, 14, seed):
        normal = infinite_form(formula)
        for form in (*factoring.forms(normal), NormalFormWriter(formula).formula(normal)):
            for word in words:
                assert holds_on_lasso(form, *word) == holds_on_lasso(formula, *word), (formula, form)


@pytest.mark.parametrize("most_steps", [2_000, pytest.param(20_000, marks=pytest.mark.slow)])
def test_labels_keep_their_meaning_and_get_no_longer(most_steps: int) -> None:
    shorter = 0
    for entry in entries():
        if entry.steps > most_steps:
            continue
        writer, words = NormalFormWriter(entry.formula), some_lassos(entry.formula.atoms(), 6, 0)
        for label in automaton_of(entry.formula).labels:
            short = writer.formula(label)
            for word in words:
                assert holds_on_lasso(short, *word) == holds_on_lasso(label, *word), (entry.formula, label, short)
            saved = len(ascii_text(with_derived_operators(label))) - len(ascii_text(short))
            assert saved >= 0, (entry.formula, short)
            shorter += saved > 0
    assert shorter > 100


def test_a_form_that_would_be_too_long_is_not_built() -> None:
    # Both the disjunctive and the conjunctive form have at least 2⁶ terms.
    half = [f"(a{i} & b{i} | c{i} & d{i})" for i in range(6)]
    label = f"({' & '.join(half)}) | ({' & '.join(part.replace('a', 'e') for part in half)}) & g"
    normal = infinite_form(read_formula(label))
    assert list(Factoring(normal.atoms()).forms(normal)) == []
    assert ascii_text(NormalFormWriter(read_formula(label)).formula(normal)) == ascii_text(read_formula(label))


# --- in English -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("formula", "sentence"),
    [
        ("G F a", "Reach a again and again."),
        ("N a", "Have a at the next step."),
        ("true U a & G X b", "Reach a; and at every step, have b at the next step."),
        ("G(a -> X true)", "Nothing remains to be done."),
        ("F a & N false", "The spec is violated."),
        ("F b & (N false | G F a)", "Reach b, and reach a again and again."),
        ("a W N false", "Keep a throughout."),
        ("!(X true -> a)", "Avoid a now."),
        ("G F a U F G (a & X true)", "From some step on keep a throughout."),
    ],
)
def test_formulas_print_as_known_sentences(formula: str, sentence: str) -> None:
    fspa = compiled(formula)
    assert (fspa.formula, formula_text(fspa)) == (read_formula(formula), sentence)


def sentence_of(formula: Formula) -> str:
    return english_text(without_constants(formula), endless=True)


@given(formulas(max_leaves=20))
@settings(deadline=None)
def test_every_formula_has_a_sentence(formula: Formula) -> None:
    assert_sentence(sentence_of(formula))


def test_a_sentence_has_one_meaning() -> None:
    """Small formulas with the same sentence agree on lassos."""
    words = some_lassos("ab", 24, 0)
    meanings: dict[str, dict[tuple[bool, ...], Formula]] = defaultdict(dict)
    for formula in (*formulas_up_to(3), *formulas_of_size(4)[::7], *formulas_of_size(5)[::97]):
        truth = tuple(holds_on_lasso(formula, *word) for word in words)
        meanings[sentence_of(formula)].setdefault(truth, formula)
    ambiguous = {
        text: [str(x) for x in formulas_by_truth.values()]
        for text, formulas_by_truth in meanings.items()
        if len(formulas_by_truth) > 1
    }
    assert not ambiguous


def test_sentences_differ_from_finite_ones_where_the_meaning_does() -> None:
    for formula in map(read_formula, ("G F a", "N a", "G(a -> N b)")):
        assert english_text(formula) != sentence_of(formula)
