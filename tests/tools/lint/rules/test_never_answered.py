"""TLT0432: implications whose two sides never hold together."""

from __future__ import annotations

import pytest
from hypothesis import given

from tests.fuzzing import times
from tests.tools.lint.helpers import APART, block, codes, findings_in, labelled_texts_in_block, spec_and_findings
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
        ("keep at(z) or (at(x) implies at(y))", []),
        ("keep at(z) implies (at(x) implies at(y))", []),
        ("require (at(x) implies at(y)) until at(z)", []),
        ("require at(z) weak_until (at(x) implies at(y))", []),
        ("keep at(z) and (at(x) implies at(y))", ["at(x) implies at(y)"]),
    ],
)
def test_implications_of_exclusive_atoms_are_reported(clause: str, expected: list[str]) -> None:
    assert labelled_texts_in_block("TLT0432", "reach at(z)", clause, before=APART) == expected


def test_an_implication_is_reported_beside_the_contradiction_that_it_causes() -> None:
    text = block("reach at(x)", "reach at(z)", "require always (at(x) implies at(y))", before=APART)
    assert {code for code in codes(text) if code != "TLT0415"} == {"TLT0410", "TLT0432"}


def test_a_clause_that_is_impossible_is_reported_as_a_contradiction_only() -> None:
    clause = "keep (!at(x) -> at(x)) and at(y)"
    assert labelled_texts_in_block("TLT0432", clause, before=APART) == []
    assert labelled_texts_in_block("TLT0410", clause, before=APART) != []
    assert labelled_texts_in_block("TLT0432", "keep (!at(x) -> at(x)) and not at(y)", before=APART) == [
        "!at(x) -> at(x)"
    ]


@times(40)
@given(specs("keep {} implies {}", "require G ({} -> {})", "require {} implies {}", most=1))
def test_the_two_sides_of_a_reported_implication_never_hold_together(drawn: tuple[World, str]) -> None:
    world, text = drawn
    spec, reported = spec_and_findings(never_answered.check, text)
    for finding in reported:
        trees = {part.tree.span: part for _, clause in spec.clauses("keep", "require") for part in clause.parts()}
        formula = trees[finding.labels[0].span].formula()
        assert formula and not any(world.traces.holding_at_some_step(and_(*formula.args)))
        assert all(any(world.traces.holding_at_some_step(side)) for side in formula.args)


@pytest.mark.parametrize(
    ("clause", "advice"),
    [
        ("keep a implies always for 1 s not a", "for the steps after it, write `a implies next always for 1 s not a`"),
        (
            "keep begins a implies (always for 10 s not begins a)",
            "for the steps after it, write `begins a implies next always for 10 s not begins a`",
        ),
        ("keep a implies always not a", "for the steps after it, write `a implies next always not a`"),
        ("keep a implies next always for 1 s not a", None),
        ("keep a implies always for 1 s not b", None),
        ("keep a implies G[1,5] not a", None),
    ],
)
def test_a_rule_that_forbids_its_own_event_is_reported(clause: str, advice: str | None) -> None:
    settings = "limit 60 s\n    judge at limit"
    text = f"clock 60 Hz\nsignal a: bool\nsignal b: bool\nspec s {{\n    {settings}\n    {clause}\n}}\n"
    found = [finding.diagnostic for finding in findings_in(text) if finding.diagnostic.code == "TLT0432"]
    assert [diagnostic.help for diagnostic in found] == ([] if advice is None else [advice])
