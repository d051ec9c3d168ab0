"""The cheap proofs of implication, and of values at the last sample, are correct whenever they give an answer."""

from __future__ import annotations

import pytest
from hypothesis import given

from tests.fuzzing import times
from tests.logic.small_formulas import formulas_of_size, formulas_up_to
from tests.logic.strategies import formulas
from tests.logic.truth_table import TruthTable
from tests.reference_formulas import read_formula
from tltlc.logic import formula as f
from tltlc.logic.formula import Formula
from tltlc.logic.implication import complement, syntactically_implies, value_at_last
from tltlc.logic.oracle import all_traces, holds

TABLE = TruthTable("ab", 4)
LAST = tuple(all_traces("ab", 1))


def test_implication_is_sound_between_small_formulas() -> None:
    small = [*formulas_up_to(3), *formulas_of_size(4)[::11]]
    for premise in small[::3]:
        for conclusion in small:
            if syntactically_implies(premise, conclusion):
                assert TABLE.implies(premise, conclusion), f"{premise} implies {conclusion}"


@times(333)
@given(formulas(("a", "b"), 6), formulas(("a", "b"), 6))
def test_implication_is_sound(premise: Formula, conclusion: Formula) -> None:
    for weaker in (conclusion, f.or_(premise, conclusion), f.until(conclusion, premise)):
        if syntactically_implies(premise, weaker):
            assert TABLE.implies(premise, weaker)


@pytest.mark.parametrize(
    ("premise", "conclusion"),
    [
        ("F(a & b)", "F a"),
        ("F(a & X F b)", "F b"),
        ("G a", "a W b"),
        ("a & b", "b | c"),
        ("a U b", "F b"),
        ("a M b", "a R b"),
        ("X a", "N a"),
        ("G F a", "F G a"),
        ("G a", "G N a"),
        ("G(a & b)", "G(c -> a)"),
        ("!F a", "G !a"),
    ],
)
def test_known_implications_are_recognised(premise: str, conclusion: str) -> None:
    p, q = read_formula(premise), read_formula(conclusion)
    if premise.startswith("!"):
        p = complement(p.args[0])
    assert syntactically_implies(p, q)
    assert not syntactically_implies(q, p) or premise == "G F a" or premise.startswith("!")


def test_implication_stops_early_on_hard_pairs() -> None:
    left, right = f.atom("a"), f.atom("b")
    for i in range(300):
        left, right = f.or_(f.next_(left), f.atom(f"a{i}")), f.and_(f.next_(right), f.atom(f"b{i}"))
    assert not syntactically_implies(left, right)


@given(formulas(("a", "b"), 8))
def test_the_complement_is_the_negation(formula: Formula) -> None:
    for depth in (0, 1, 5):
        assert TABLE.of(complement(formula, depth)) == TABLE.of(f.not_(formula))


@given(formulas(("a", "b"), 8))
def test_the_value_at_the_last_sample_agrees_with_the_oracle(formula: Formula) -> None:
    value = value_at_last(formula)
    if value is not None:
        assert all(holds(formula, trace) == value for trace in LAST)


@pytest.mark.parametrize(("formula", "value"), [("F X a", False), ("a | N b", True), ("a & X b", False), ("a", None)])
def test_the_value_at_the_last_sample_is_found_unless_atoms_decide(formula: str, value: bool | None) -> None:
    assert value_at_last(read_formula(formula)) is value
