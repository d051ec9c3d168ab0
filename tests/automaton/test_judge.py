"""The default judge of a spec without a ``judge`` clause (``docs/semantics.md``, "When a spec is judged")."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

import tltlc
from tests.reference_formulas import read_formula
from tltlc.automaton.default_judge import default_judge

SIGNALS = "signal a: bool signal b: bool signal c: bool\n"


@pytest.mark.parametrize(
    ("text", "judge"),
    [
        ("G p", "limit"),
        ("a & G b", "limit"),
        ("G(a -> F b)", "limit"),
        ("F e & G p", "goal"),
        ("a U b", "goal"),
        ("a W b", "limit"),
        ("!F a", "limit"),
        ("!G a", "goal"),
        ("a | X a", "goal"),
        ("a | X(a | X a)", "goal"),
        ("(a | X(a | X a)) & G b", "goal"),
        ("(a | b | X(a | b | X(a | b))) & G c", "goal"),
        ("c | a | X(a | X a)", "limit"),
        ("a & N(a & N a)", "limit"),
    ],
)
def test_formulas_true_of_nothing_yet_are_judged_at_the_limit(text: str, judge: str) -> None:
    assert default_judge(read_formula(text)) == judge


@pytest.mark.parametrize(
    ("clauses", "judge"),
    [
        ("require eventually within 0 steps a", "goal"),
        ("require F[0,0] a", "goal"),
        ("require (eventually within 1 step a) or eventually b", "goal"),
        ("require eventually b or eventually within 1 step a", "goal"),
        ("require F[0,1] a | F[0,1] b", "goal"),
        ("require F[0,2] a | F[0,1] a", "goal"),
        ("require F[0,0] a | F[2,3] b", "goal"),
        ("require (eventually within 0.1 s a) or eventually b", "goal"),
        ("keep c require (eventually within 1 step a) or eventually b", "goal"),
        ("require b or eventually within 1 step a", "limit"),
        ("require not eventually within 0 steps a", "limit"),
        ("require not always for 1 step a", "goal"),
        ("require eventually b implies eventually within 1 step a", "limit"),
        ("require always for 3 steps eventually a", "limit"),
        ("require always for 1 step eventually a", "limit"),
        ("require G[1,2] F a", "limit"),
        ("require always for 3 steps eventually within 2 steps a", "limit"),
        ("require next after 1 step a", "goal"),
        ("require next after 0 steps a", "limit"),
        ("require soon", "goal"),
        ("keep b require soon", "goal"),
        ("require now(c) or soon", "goal"),
        ("require any x in (k, l): soon_at(x)", "goal"),
        ("require a", "limit"),
    ],
)
def test_bounds_keep_the_default_judge(clauses: str, judge: str) -> None:
    assert judge_of(clauses) == judge


BOUNDS = {"F": ("F[0,0]", "F[0,1]", "F[0,2]", "F[1,2]"), "G": ("G[0,0]", "G[0,1]", "G[0,2]", "G[1,2]")}


OPERANDS = ("F a", "G a", "F G b", "G F b", "F (a & G c)", "G (a -> F c)", "a", "!F a", "b U c")


@given(st.lists(st.sampled_from(OPERANDS), min_size=1, max_size=5), st.sampled_from(["|", "&", "->"]), st.data())
def test_a_formula_has_the_same_judge_without_bounds(operands: list[str], sign: str, data: st.DataObject) -> None:
    plain = f" {sign} ".join(f"({operand})" for operand in operands)
    bounded = "".join(data.draw(st.sampled_from((character, *BOUNDS.get(character, ())))) for character in plain)
    assert judge_of(f"require {bounded}") == judge_of(f"require {plain}")


def test_the_bounds_of_a_let_count_in_every_clause_that_uses_it() -> None:
    assert judge_of("require soon or F b require soon or F c") == "goal"


def judge_of(clauses: str) -> str:
    """Return the judge of a spec with these clauses."""
    text = f"""
        clock 10 Hz
        {SIGNALS}
        entity k, l
        signal near(e): bool
        let soon = eventually within 0 steps a
        let now(p: formula) = F[0,0] p
        let soon_at(e: entity) = eventually within 1 step near(e)
        spec s {{ limit 9 steps {clauses} }}
    """
    (fspa,) = tltlc.compile_text(text)
    return fspa.judge
