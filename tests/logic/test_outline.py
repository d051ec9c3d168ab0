"""The outline of a formula: goals, constraints that hold throughout, recurring goals, and the rest."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.fuzzing import times
from tests.logic.strategies import formulas
from tests.reference_formulas import read_formula
from tltlc.automaton.infinite.readback import without_constants
from tltlc.logic.formula import Formula
from tltlc.logic.text.english import english_text
from tltlc.logic.text.outline import Goal, Outline, outline

SMALL = formulas(max_leaves=8)


def goals(*texts: str) -> tuple[Goal, ...]:
    return tuple(map(Goal, texts))


@pytest.mark.parametrize(
    ("formula", "expected"),
    [
        ("F(a & X F(b & X F c)) & G !d", Outline((goals("a", "b", "c"),), ("avoid d",))),
        ("F a & F b", Outline((goals("a"), goals("b")))),
        ("F(a & F b)", Outline(((Goal("a"), Goal("b", together=True)),))),
        ("G(a & !b)", Outline(throughout=("keep a", "avoid b"))),
        ("G G(a & G !b)", Outline(throughout=("keep a", "avoid b"))),
        ("G(a -> F b)", Outline(throughout=("whenever a, reach b at that step or later",))),
        # Here "throughout" belongs to the sentence, not to the heading of the list.
        ("G(a -> G b)", Outline(throughout=("whenever a, keep b throughout",))),
        ("F G a & a U b", Outline(others=("from some step on keep a throughout", "reach b, keeping a until then"))),
        ("true", Outline()),
        ("false", Outline(others=("satisfy a condition that no trace can satisfy",))),
    ],
)
def test_an_outline_sorts_the_conjuncts_of_a_formula(formula: str, expected: Outline) -> None:
    assert outline(read_formula(formula)) == expected


def test_an_outline_over_infinite_traces_lists_recurring_goals() -> None:
    result = outline(read_formula("G F a & F b & G c & G(a -> F b)"), endless=True)
    assert result.recurring == ("reach a",)
    assert result.goals == (goals("b"),)
    assert result.throughout == ("keep c", "whenever a, reach b at that step or later")


@times(100)
@given(SMALL, st.booleans())
def test_the_outline_of_every_formula_is_in_english(formula: Formula, endless: bool) -> None:
    formula = without_constants(formula) if endless else formula
    result = outline(formula, endless=endless)
    texts = [goal.text for row in result.goals for goal in row] + [
        *result.throughout,
        *result.recurring,
        *result.others,
    ]
    assert all(texts) and all(text == text.strip() for text in texts)
    assert texts or english_text(formula, endless=endless) == "Nothing remains to be done."
