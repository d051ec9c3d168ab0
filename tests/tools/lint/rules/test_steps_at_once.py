"""TLT0415: goals at several places that one step can meet."""

from __future__ import annotations

import re

import pytest
from hypothesis import given

import tltlc
from tests.fuzzing import times
from tests.tools.lint.helpers import APART, PLACES, block, findings_in, labelled_texts_in_block, spec_and_findings
from tests.tools.lint.strategies import World, specs
from tests.tools.lint.traces import Traces
from tltlc.tools.lint.rules import steps_at_once


@pytest.mark.parametrize(
    ("clauses", "before", "is_reported"),
    [
        (("reach at(x)", "reach at(y)"), PLACES, True),
        (("reach at(x)", "reach at(y)"), APART, False),
        (("reach at(x) then at(y)",), PLACES, False),
        (("reach at(x) then at(y)", "reach at(z)"), APART, True),
        (("reach at(x) or at(y)",), PLACES, False),
        # Exclusive atoms would not make the distance to the goal longer here.
        (("keep at(x)", "require N eventually at(y)"), PLACES, False),
        (("avoid next not at(x)", "require N at(x) until at(z)"), PLACES, False),
        (("reach at(x)", "reach d(y) < 3 m"), PLACES, False),
    ],
)
def test_goals_that_one_step_may_meet_are_reported(clauses: tuple[str, ...], before: str, is_reported: bool) -> None:
    assert ("s" in labelled_texts_in_block("TLT0415", *clauses, before=before)) == is_reported


@pytest.mark.parametrize(
    "clauses",
    [
        ("reach at(x)", "keep at(y)"),
        ("reach at(x)", "require always at(y)"),
        ("reach at(x)", "require at(y) until at(x)"),
        ("reach at(x)", "require F (at(y) U at(x))"),
        ("reach at(x)", "reach at(y)", "keep at(x)"),
    ],
)
def test_a_condition_that_is_kept_is_not_a_second_goal(clauses: tuple[str, ...]) -> None:
    assert labelled_texts_in_block("TLT0415", *clauses, before=PLACES) == []


def test_the_suggested_exclusive_never_makes_a_spec_impossible() -> None:
    for clauses in (
        ("reach at(x) and at(y)",),
        ("reach all e in (x, y): at(e)",),
        ("reach at(x) and at(y)", "reach at(z)"),
        ("reach at(x)", "reach at(y)", "reach at(x) and at(y)"),
        ("reach at(x) and at(y) and at(z)",),
    ):
        helps = [
            finding.diagnostic.help
            for finding in findings_in(block(*clauses, before=PLACES))
            if finding.diagnostic.code == "TLT0415"
        ]
        assert [text for text in helps if "exclusive" in (text or "")] == []
        assert [text for text in helps if " then " in (text or "")]


@pytest.mark.parametrize(
    "clauses",
    [
        # Exclusive atoms would lengthen some steps in between, but neither the shortest way from the start
        # nor the longest distance.
        ("reach at(x) then at(y)", "require G (at(z) -> F at(x))"),
        ("reach at(x)", "require X F at(z)"),
        ("reach at(x) then at(z)", "reach at(x) or at(y)"),
    ],
)
def test_goals_are_not_reported_if_exclusive_lengthens_no_path(clauses: tuple[str, ...]) -> None:
    assert labelled_texts_in_block("TLT0415", *clauses, before=PLACES) == []


def test_the_suggested_exclusive_has_atoms_of_one_predicate() -> None:
    before = PLACES + "signal seen(e): bool\n"
    helps = [
        finding.diagnostic.help
        for finding in findings_in(block("reach at(x)", "reach at(y)", "reach seen(x)", "reach seen(y)", before=before))
        if finding.diagnostic.code == "TLT0415"
    ]
    matches = [re.search("`exclusive (.*)`", text or "") for text in helps]
    assert [match and match[1] for match in matches] == ["at(x), at(y)", "seen(x), seen(y)"]


def test_exclusive_atoms_add_a_step_of_progress() -> None:
    clauses = ("reach at(x)", "reach at(y)")
    (joint,) = tltlc.compile_text(block(*clauses, before=PLACES))
    (apart,) = tltlc.compile_text(block(*clauses, before=APART))
    assert (joint.spec_size, apart.spec_size) == (1, 2)


NEAR = World("entity x, y, z\nsignal at(e): bool\nsignal b: bool\n", ("at(x)", "at(y)", "at(z)", "b"), Traces(()))


@times(40)
@given(specs("reach {}", "reach at(x)", "reach at(y) then {}", "require {}", "keep {}", worlds=[NEAR]))
def test_the_suggested_exclusive_lengthens_the_spec_and_keeps_it_possible(drawn: tuple[World, str]) -> None:
    _, text = drawn
    spec, reported = spec_and_findings(steps_at_once.check, text)
    for finding in reported:
        excluded = re.search("`(exclusive .*)`", finding.help)
        if excluded:
            (apart,) = tltlc.compile_text(f"{excluded[1]}\n{text}")
            assert apart.states[0].verdict != "violated"
            longer = (apart.states[0].distance or 0, apart.spec_size)
            assert longer > (spec.fspa.states[0].distance or 0, spec.fspa.spec_size)
