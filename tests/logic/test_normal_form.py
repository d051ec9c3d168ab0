"""Negation normal form: its form, its meaning and its cost."""

from __future__ import annotations

import pytest
from hypothesis import given

from tests.logic.small_formulas import formulas_up_to
from tests.logic.strategies import formulas
from tests.logic.truth_table import TruthTable
from tests.reference_formulas import corpus, read_formula
from tltlc.logic import formula as f
from tltlc.logic.formula import Formula
from tltlc.logic.normal_form import negation_normal_form

TABLE = TruthTable("abc", 3)


def in_normal_form(formula: Formula) -> bool:
    return all(
        node.op not in ("implies", "iff") and (node.op != "not" or node.args[0].op == "atom") for node in formula.walk()
    )


@given(formulas(max_leaves=12))
def test_the_normal_form_is_normal_and_keeps_the_meaning(formula: Formula) -> None:
    normal = negation_normal_form(formula)
    assert in_normal_form(normal)
    assert TABLE.of(normal) == TABLE.of(formula)
    assert negation_normal_form(normal) is normal


def test_every_small_formula_keeps_its_meaning() -> None:
    for formula in formulas_up_to(4):
        assert TABLE.of(negation_normal_form(formula)) == TABLE.of(formula), str(formula)


def test_the_corpus_is_normalised() -> None:
    assert all(in_normal_form(negation_normal_form(entry.formula)) for entry in corpus())


@pytest.mark.parametrize(
    ("formula", "normal"),
    [
        ("F(a & X F b) & G c", "F(a & X F b) & G c"),
        ("!(a -> X b)", "a & N !b"),
        ("a -> b -> c", "!a | !b | c"),
        ("a <-> b", "a & b | !a & !b"),
        ("!(a <-> b)", "a & !b | !a & b"),
        ("!(a U (b W c))", "!a R !b M !c"),
        ("!!a & a", "a"),
        ("!true", "false"),
    ],
)
def test_negations_move_to_the_atoms(formula: str, normal: str) -> None:
    assert str(negation_normal_form(read_formula(formula))) == normal


def test_shared_subformulas_are_visited_once() -> None:
    implied, equal = f.atom("a"), f.atom("b")
    for _ in range(200):
        implied, equal = f.implies(f.not_(implied), f.next_(implied)), f.iff(f.next_(equal), equal)
    assert len(list(negation_normal_form(implied).walk())) < 1000
    assert len(list(negation_normal_form(equal).walk())) < 2000


@pytest.mark.parametrize("nest", [f.not_, f.next_, lambda inner: f.implies(f.atom("p"), inner)], ids=["!", "X", "->"])
def test_deep_formulas_are_normalised(nest: object) -> None:
    assert callable(nest)
    formula = f.atom("a")
    for _ in range(10_000):
        formula = nest(formula)
    assert in_normal_form(negation_normal_form(f.not_(formula)))
