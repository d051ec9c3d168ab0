"""TLT0432: implications whose two sides never hold together."""

from __future__ import annotations

import pytest
from hypothesis import given

from tests.tools.lint.helpers import APART, block, codes, of, remarks
from tests.tools.lint.strategies import World, specs
from tltlc.logic.formula import and_
from tltlc.tools.lint.rules import never_answered


@pytest.mark.parametrize(
    ("clause", "expected"),
    [
        ("require always (at(x) implies at(y))", ["at(x) implies at(y)"]),
        ("keep at(x) implies at(y)", ["at(x) implies at(y)"]),
        ("keep d(x) > 5 m implies d(x) < 2 m", ["d(x) > 5 m implies d(x) < 2 m"]),
        ("require always (at(x) implies eventually at(y))", []),
        ("require always (at(x) implies not at(y))", []),
        ("require always (at(x) implies at(z))", []),
        ("keep d(x) > 5 m implies d(x) > 2 m", []),
        ("keep at(x) implies false", []),
        ("require not (at(x) implies at(y))", []),
        ("require F (at(x) implies at(y))", []),
        ("keep at(z) iff (at(x) implies at(y))", []),
    ],
)
def test_implications_that_are_never_answered(clause: str, expected: list[str]) -> None:
    assert of("TLT0432", "reach at(z)", clause, before=APART) == expected


def test_an_implication_is_told_beside_the_contradiction_that_it_makes() -> None:
    text = block("reach at(x)", "reach at(z)", "require always (at(x) implies at(y))", before=APART)
    assert {code for code in codes(text) if code != "TLT0415"} == {"TLT0410", "TLT0432"}


def test_a_clause_that_can_never_be_met_forbids_more_than_one_side() -> None:
    clause = "keep (!at(x) -> at(x)) and at(y)"
    assert of("TLT0432", clause, before=APART) == []
    assert of("TLT0410", clause, before=APART) != []
    assert of("TLT0432", "keep (!at(x) -> at(x)) and not at(y)", before=APART) == ["!at(x) -> at(x)"]


@given(specs("keep {} implies {}", "require G ({} -> {})", "require {} implies {}", most=1))
def test_no_step_has_both_sides_and_some_step_has_each(drawn: tuple[World, str]) -> None:
    world, text = drawn
    spec, told = remarks(never_answered.check, text)
    for remark in told:
        trees = {each.tree.span: each for _, clause in spec.clauses("keep", "require") for each in clause.parts()}
        formula = trees[remark.labels[0].span].formula()
        assert formula and not any(world.traces.ever(and_(*formula.args)))
        assert all(any(world.traces.ever(side)) for side in formula.args)
