"""TLT0414: goals that require exclusive atoms at the same step."""

from __future__ import annotations

import pytest
from hypothesis import given

from tests.fuzzing import times
from tests.tools.lint.helpers import APART, PLACES, labelled_texts_in_block, spec_and_findings
from tests.tools.lint.strategies import EXCLUSIVE, World, specs
from tltlc.tools.lint.file_view import without_brackets
from tltlc.tools.lint.goals import goals
from tltlc.tools.lint.rules import exclusive_goal


@pytest.mark.parametrize(
    ("clause", "expected"),
    [
        ("reach at(x) and at(y)", ["at(x) and at(y)"]),
        ("reach at(z) then (at(x) and at(y))", ["at(x) and at(y)"]),
        ("require F (at(x) & F at(z) & at(y))", ["at(x) & F at(z) & at(y)"]),
        ("require F all e in (x, y): at(e)", ["all e in (x, y): at(e)"]),
        ("reach at(x) and at(z)", []),
        ("reach at(x) and not at(y)", []),
        ("reach at(x) then at(y)", []),
        ("reach at(x) or at(y)", []),
    ],
)
def test_goals_of_exclusive_atoms_are_reported(clause: str, expected: list[str]) -> None:
    assert labelled_texts_in_block("TLT0414", clause, before=APART) == expected
    assert labelled_texts_in_block("TLT0414", clause, before=PLACES) == []
    assert labelled_texts_in_block("TLT0410", clause, before=APART) == []


def test_the_warning_of_the_compiler_stays_if_it_has_another_reason() -> None:
    assert labelled_texts_in_block("TLT0410", "reach at(x) and at(y)", "reach at(z)", "avoid at(z)", before=APART) != []


@times(40)
@given(specs("reach {} and {}", "reach {} then ({} and {})", "require F ({} & {})", worlds=[EXCLUSIVE], most=1))
def test_no_step_meets_a_reported_goal(drawn: tuple[World, str]) -> None:
    world, text = drawn
    spec, reported = spec_and_findings(exclusive_goal.check, text)
    for finding in reported:
        (goal,) = (
            candidate for candidate in goals(spec) if without_brackets(candidate.tree).span == finding.labels[0].span
        )
        formula = goal.formula()
        assert formula and not any(world.traces.holding_at_some_step(formula))
