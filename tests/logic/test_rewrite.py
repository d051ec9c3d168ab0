"""Each rewriting law, and the simplifier, agree with the original formula on all short traces."""

from __future__ import annotations

import pytest
from hypothesis import given

from tests.fuzzing import times
from tests.logic.small_formulas import formulas_up_to
from tests.logic.strategies import formulas
from tests.logic.truth_table import TruthTable
from tests.reference_formulas import corpus, read_formula
from tltlc.logic import formula as f
from tltlc.logic.formula import Formula
from tltlc.logic.oracle import all_traces, holds
from tltlc.logic.rewrite import REWRITES, Rewrite, simplify, size

LAWS = [
    pytest.param(rewrite, law, id=f"{rewrite.name}: {law.strip()}")
    for rewrite in REWRITES
    for law in rewrite.law.split(";")
]
TABLE = TruthTable("abc", 3)
SMALL_TABLE = TruthTable("ab", 4)


@pytest.mark.parametrize(("rewrite", "law"), LAWS)
def test_each_law_holds_on_all_traces_up_to_length_4(rewrite: Rewrite, law: str) -> None:
    left, right = (read_formula(side) for side in law.split("="))
    assert rewrite.apply(left) is right
    assert size(right) <= size(left)
    atoms = list(dict.fromkeys([*left.atoms(), *right.atoms()]))
    if len(atoms) < 3:
        assert all(holds(left, trace) == holds(right, trace) for trace in all_traces(atoms, 4))
    else:
        table = TruthTable(atoms, 4)
        assert table.of(left) == table.of(right)


def test_each_rewrite_keeps_the_meaning_of_every_small_formula() -> None:
    for formula in formulas_up_to(5):
        for rewrite in REWRITES:
            if formula.op in rewrite.ops:
                assert_sound(rewrite, formula, SMALL_TABLE)


@times(166)
@given(formulas(("a", "b", "c"), 12))
def test_each_rewrite_keeps_the_meaning_and_never_lengthens(formula: Formula) -> None:
    for node in formula.walk():
        for rewrite in REWRITES:
            if node.op in rewrite.ops:
                assert_sound(rewrite, node, TABLE)


def assert_sound(rewrite: Rewrite, formula: Formula, table: TruthTable) -> None:
    rewritten = rewrite.apply(formula)
    if rewritten is not formula:
        assert table.of(rewritten) == table.of(formula), f"{rewrite.name}: {formula} = {rewritten}"
        assert size(rewritten) <= size(formula), f"{rewrite.name}: {formula} = {rewritten}"


def test_simplify_keeps_the_meaning_of_every_small_formula() -> None:
    for formula in formulas_up_to(5):
        simpler = simplify(formula)
        assert SMALL_TABLE.of(simpler) == SMALL_TABLE.of(formula), f"{formula} = {simpler}"
        assert size(simpler) <= size(formula)
        assert simplify(simpler) is simpler


@times(166)
@given(formulas(("a", "b", "c"), 20))
def test_simplify_keeps_the_meaning_and_never_lengthens(formula: Formula) -> None:
    simpler = simplify(formula)
    assert TABLE.of(simpler) == TABLE.of(formula)
    assert size(simpler) <= size(formula)
    assert simplify(simpler) is simpler


@pytest.mark.parametrize(
    ("formula", "simple"),
    [
        ("((F c | F(b & X F c)) | F(a & X F(b & X F c))) & G p", "F c & G p"),
        ("F(a & X F(b & X F c)) & G p", "F(a & X F(b & X F c)) & G p"),
        ("X true", "X true"),
        ("N false", "N false"),
        ("a & (F a | b)", "a"),
        ("G(a -> F b)", "G(a -> F b)"),
        ("(F c & G p) | (F(b & X F c) & G p)", "F c & G p"),
        ("F b & X true & G a", "F b & X true & G a"),
    ],
)
def test_simplify_gives_the_known_short_form(formula: str, simple: str) -> None:
    assert str(simplify(read_formula(formula))) == simple


def test_simplify_never_makes_a_formula_of_the_corpus_longer() -> None:
    entries = list(corpus())
    assert all(size(simplify(entry.formula)) <= size(entry.formula) for entry in entries)


@pytest.mark.parametrize("make", [f.next_, f.not_, f.eventually], ids=["X", "not", "F"])
def test_simplify_handles_deep_formulas(make: object) -> None:
    assert callable(make)
    formula = f.atom("a")
    for _ in range(10_000):
        formula = make(formula)
    assert size(simplify(formula)) <= 10_001


def test_simplify_handles_wide_formulas() -> None:
    wide = f.and_(*(f.eventually(f.atom(f"a{i}")) for i in range(10_000)))
    assert simplify(wide) is wide


def test_size_counts_the_printed_symbols() -> None:
    assert size(read_formula("a & b & !c -> X true")) == 9
