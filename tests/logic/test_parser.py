"""The parser of the ASCII notation reads back what the printer prints."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.logic.small_formulas import formulas_up_to
from tests.logic.strategies import formulas
from tests.reference_formulas import corpus, read_formula
from tltlc.logic import formula as f
from tltlc.logic.formula import Formula
from tltlc.logic.text import parser as parser_module
from tltlc.logic.text.parser import FormulaParser
from tltlc.logic.text.printer import ascii_text, operand_text

NAMES = ("a", "near(s1)", "near(s1, close=2)", "health > 0.5", "health", "(x + y) / 2 < 3", "a.b", "F_1", "X(a)")


def parse(formula: Formula, text: str | None = None) -> Formula | None:
    return FormulaParser(formula.atoms()).formula(ascii_text(formula) if text is None else text)


@given(formula=formulas(NAMES, max_leaves=12))
def test_every_formula_is_read_back(formula: Formula) -> None:
    assert FormulaParser(NAMES).formula(ascii_text(formula)) is formula
    assert FormulaParser(reversed(NAMES)).formula(operand_text(formula)) is formula


def test_every_small_formula_is_read_back() -> None:
    for formula in formulas_up_to(3):
        assert parse(formula) is formula


def test_every_formula_of_the_corpus_is_read_back() -> None:
    for entry in corpus():
        assert parse(entry.formula) is entry.formula


@given(body=formulas(NAMES, max_leaves=4), steps=st.integers(0, 8), op=st.sampled_from("FG"))
def test_bounds_are_expanded(body: Formula, steps: int, op: str) -> None:
    formula = body
    for _ in range(steps):
        formula = f.or_(body, f.next_(formula)) if op == "F" else f.and_(body, f.weak_next(formula))
    parser = FormulaParser(NAMES)
    assert parser.formula(ascii_text(formula)) is formula
    assert parser.formula(f"{op}[0,{steps}] ({ascii_text(body)})") is formula


@given(formulas(max_leaves=12))
def test_blanks_and_brackets_do_not_matter(formula: Formula) -> None:
    text = ascii_text(formula).replace("(", " ( ").replace("&", " \n& ")
    assert parse(formula, f" (({text})) ") is formula
    assert read_formula(text) is formula


@pytest.mark.parametrize(
    "text",
    [
        *("", "  ", "(", ")", "a)", "(a", "a b", "a &", "& a", "a ! b", "F", "F[0,3]", "F[1,3] a", "F[0,-1] a", "b"),
        *("ab", "trueish", "a true", "!", "a <- b", "a () a", "F[0,99999999] a", "aé", "both (1 of 2)"),
    ],
)
def test_other_texts_are_no_formulas(text: str) -> None:
    assert FormulaParser(["a"]).formula(text) is None


@given(st.text(alphabet="ab()!&|-><FGXNU[],0 1truefals", max_size=20), st.lists(st.text(max_size=4), max_size=3))
def test_any_text_over_any_names_is_a_formula_or_none(text: str, names: list[str]) -> None:
    formula = FormulaParser(["a", *names]).formula(text)
    assert formula is None or set(formula.atoms()) <= {"a", *names}


def test_deep_formulas_need_no_recursion() -> None:
    formula = f.atom("a")
    for _ in range(50_000):
        formula = f.not_(f.until(formula, f.atom("b")))
    assert parse(formula) is formula


def test_bounds_that_count_down_share_their_expansion(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(parser_module, "WORK", {"expanded bounds": 3_000})
    parser = FormulaParser(["a", "b"])
    for steps in range(3_000, 0, -1):
        assert parser.formula(f"F[0,{steps}] a") is not None
    assert parser.formula("F[0,2] b") is None
