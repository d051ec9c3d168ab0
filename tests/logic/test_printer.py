"""Formulas as text: known texts, and texts that are read back."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.logic.small_formulas import formulas_up_to
from tests.logic.strategies import formulas
from tests.reference_formulas import corpus, read_formula
from tltlc.core.names import ComparisonName
from tltlc.core.source import SourceFile
from tltlc.grammar import tree
from tltlc.grammar.parser import parse_formula
from tltlc.logic import formula as f
from tltlc.logic.formula import FALSE, TRUE, Formula
from tltlc.logic.text.printer import ascii_text, is_ascii_text, unicode_text, words_text

HEALTHY = ComparisonName("health", ">", "0.5")
NAMES = ("a", "near(s1)", "spatial.near(s1, close = 2)", HEALTHY)
NOTATIONS = pytest.mark.parametrize("write", [ascii_text, unicode_text, words_text])


@pytest.mark.parametrize(
    ("text", "unicode", "words"),
    [
        (
            "F(near(s1) & X F(near(s2) & X F near(exit))) & G alive",
            "◇(near(s1) ∧ ○◇(near(s2) ∧ ○◇near(exit))) ∧ □alive",
            "eventually (near(s1) and next eventually (near(s2) and next eventually near(exit))) and always alive",
        ),
        ("!near(s1)", "¬near(s1)", "not near(s1)"),
        ("!F a & G !a & !!a", "¬◇a ∧ □¬a ∧ ¬¬a", "not eventually a and always not a and not not a"),
        ("a U b", "a 𝒰 b", "a until b"),
        ("a U b W c", "a 𝒰 b W c", "a until b weak_until c"),
        ("(a R b) M c", "(a R b) M c", "(a release b) strong_release c"),
        ("a -> b -> c", "a ⇒ b ⇒ c", "a implies b implies c"),
        ("(a -> b) -> c", "(a ⇒ b) ⇒ c", "(a implies b) implies c"),
        ("a <-> (b <-> c)", "a ⇔ (b ⇔ c)", "a iff (b iff c)"),
        ("(a <-> b) <-> c", "(a ⇔ b) ⇔ c", "(a iff b) iff c"),
        ("a | b & c", "a ∨ b ∧ c", "a or b and c"),
        ("(a | b) & c", "(a ∨ b) ∧ c", "(a or b) and c"),
        ("N(a | b) | N F a", "N(a ∨ b) ∨ N ◇a", "weak_next (a or b) or weak_next eventually a"),
        ("X true & N false", "○⊤ ∧ N ⊥", "next true and weak_next false"),
        ("F(a U b) U !c", "◇(a 𝒰 b) 𝒰 ¬c", "eventually (a until b) until not c"),
    ],
)
def test_formulas_print_as_known_texts(text: str, unicode: str, words: str) -> None:
    formula = read_formula(text)
    assert (ascii_text(formula), unicode_text(formula), words_text(formula)) == (text, unicode, words)
    assert str(formula) == text
    assert repr(formula) == f"<Formula {text}>"


def test_a_formula_has_its_texts_as_properties() -> None:
    formula = f.and_(f.eventually(f.atom("a")), f.always(f.not_(f.atom("b"))))
    assert formula.ascii == "F a & G !b"
    assert formula.unicode == "◇a ∧ □¬b"
    assert formula.english == "Reach a, and avoid b throughout."


@pytest.mark.parametrize(
    ("formula", "text"),
    [
        (f.atom(HEALTHY), "health > 0.5"),
        (f.not_(f.atom(HEALTHY)), "!(health > 0.5)"),
        (f.eventually(f.atom(HEALTHY)), "F(health > 0.5)"),
        (f.and_(f.atom(ComparisonName("x", "<", "1")), f.next_(f.not_(f.atom("a")))), "(x < 1) & X !a"),
    ],
)
def test_a_comparison_that_is_an_operand_has_brackets(formula: Formula, text: str) -> None:
    assert ascii_text(formula) == text


@NOTATIONS
@given(formula=formulas(NAMES, max_leaves=12))
def test_the_grammar_reads_every_notation_back(write: Callable[[Formula], str], formula: Formula) -> None:
    assert parse(write(formula)) is formula


@NOTATIONS
def test_the_grammar_reads_every_small_formula_back(write: Callable[[Formula], str]) -> None:
    for formula in formulas_up_to(3):
        assert parse(write(formula)) is formula


@given(formulas(max_leaves=20))
def test_the_reference_reader_reads_the_ascii_notation_back(formula: Formula) -> None:
    assert read_formula(ascii_text(formula)) is formula


def test_every_formula_of_the_corpus_is_read_back() -> None:
    for entry in corpus():
        assert read_formula(ascii_text(entry.formula)) is entry.formula


@given(formulas(max_leaves=8))
def test_no_brackets_are_superfluous(formula: Formula) -> None:
    text = ascii_text(formula)
    opened: list[int] = []
    for index, character in enumerate(text):
        if character == "(":
            opened.append(index)
        elif character == ")":
            start = opened.pop()
            without = f"{text[:start]} {text[start + 1 : index]} {text[index + 1 :]}"
            # The printer always groups <-> with brackets, to help the reader.
            assert "<->" in text or read_formula(without) is not formula


@NOTATIONS
@pytest.mark.parametrize(
    "nest",
    [f.not_, f.eventually, lambda inner: f.until(f.atom("p"), inner), lambda inner: f.until(inner, f.atom("p"))],
    ids=["not", "F", "U right", "U left"],
)
def test_deep_formulas_are_printed(write: Callable[[Formula], str], nest: Callable[[Formula], Formula]) -> None:
    formula = f.atom("a")
    for _ in range(10_000):
        formula = nest(formula)
    assert len(write(formula)) > 10_000


def parse(text: str) -> Formula:
    """Parse a text with the grammar of the language, and convert the tree to a formula with code of this test."""
    source = SourceFile("formula", text)
    expr, diagnostics = parse_formula(source)
    assert not diagnostics, (text, diagnostics)
    assert expr is not None
    return _from_tree(expr, source)


def bounded_formula(op: str, last: int, body: Formula) -> Formula:
    """Return ``F[0,last] body`` or ``G[0,last] body``, expanded as the language expands it."""
    result = body
    for _ in range(last):
        result = f.or_(body, f.next_(result)) if op == "F" else f.and_(body, f.weak_next(result))
    return result


@given(st.sampled_from("FG"), st.integers(2, 6), formulas(max_leaves=4), formulas(max_leaves=4))
def test_bounds_are_written_as_bounds_and_read_back(op: str, last: int, body: Formula, other: Formula) -> None:
    formula = bounded_formula(op, last, body)
    for whole in (formula, f.not_(formula), f.and_(other, formula), f.or_(formula, other), f.until(other, formula)):
        for write in (ascii_text, unicode_text, words_text):
            assert parse(write(whole)) is whole


@pytest.mark.parametrize(
    ("formula", "text"),
    [
        (bounded_formula("F", 20, f.atom("a")), "F[0,20] a"),
        (bounded_formula("G", 2, f.or_(f.atom("a"), f.atom("b"))), "G[0,2](a | b)"),
        (bounded_formula("F", 1, f.atom("a")), "a | X a"),
        (f.next_(bounded_formula("F", 3, f.or_(f.atom("a"), f.atom("b")))), "X F[0,3](a | b)"),
        (f.and_(f.atom("b"), bounded_formula("G", 2, f.atom("a")), f.atom("c")), "b & G[0,2] a & c"),
        (f.or_(f.atom("b"), bounded_formula("F", 2, f.or_(f.atom("a"), f.atom("c")))), "b | F[0,2](a | c)"),
    ],
)
def test_bounds_of_two_or_more_steps_print_as_bounds(formula: Formula, text: str) -> None:
    assert ascii_text(formula) == text


_UNARY = {"not": f.not_, "X": f.next_, "N": f.weak_next, "F": f.eventually, "G": f.always}
_BINARY: dict[str, Callable[[Formula, Formula], Formula]] = {
    "and": f.and_,
    "or": f.or_,
    "implies": f.implies,
    "iff": f.iff,
    "U": f.until,
    "W": f.weak_until,
    "R": f.release,
    "M": f.strong_release,
}


def _from_tree(expr: tree.Expr, source: SourceFile) -> Formula:
    match expr:
        case tree.GroupExpr():
            return _from_tree(expr.inner, source)
        case tree.Constant():
            return TRUE if expr.value else FALSE
        case tree.Unary() if expr.bound is not None:
            last = int(expr.bound.high.value) - (expr.op == "G" and expr.bound.words)
            return bounded_formula(expr.op, last, _from_tree(expr.operand, source))
        case tree.Unary() if expr.op in _UNARY:
            return _UNARY[expr.op](_from_tree(expr.operand, source))
        case tree.BinaryExpr() if expr.op in _BINARY:
            return _BINARY[expr.op](_from_tree(expr.left, source), _from_tree(expr.right, source))
        case _:
            return f.atom(source.slice(expr.span))


@given(formula=formulas(NAMES, max_leaves=8), other=formulas(NAMES, max_leaves=8))
def test_a_text_is_compared_with_the_printed_formula(formula: Formula, other: Formula) -> None:
    text = ascii_text(formula)
    assert is_ascii_text(formula, text)
    assert not is_ascii_text(formula, text[:-1])
    assert not is_ascii_text(formula, f"{text} ")
    assert is_ascii_text(other, text) == (ascii_text(other) == text)
