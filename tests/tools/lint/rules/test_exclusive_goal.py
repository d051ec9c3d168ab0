"""TLT0414: goals that ask for exclusive atoms."""

from __future__ import annotations

import pytest
from hypothesis import given

from tests.tools.lint.helpers import APART, PLACES, of, remarks
from tests.tools.lint.strategies import EXCLUSIVE, World, specs
from tltlc.tools.lint.file_view import inner
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
def test_goals_that_are_exclusive(clause: str, expected: list[str]) -> None:
    assert of("TLT0414", clause, before=APART) == expected
    assert of("TLT0414", clause, before=PLACES) == []
    assert of("TLT0410", clause, before=APART) == []


def test_the_compilers_warning_stays_where_it_says_something_else() -> None:
    assert of("TLT0410", "reach at(x) and at(y)", "reach at(z)", "avoid at(z)", before=APART) != []


@given(specs("reach {} and {}", "reach {} then ({} and {})", "require F ({} & {})", worlds=[EXCLUSIVE], most=1))
def test_no_step_meets_the_goal(drawn: tuple[World, str]) -> None:
    world, text = drawn
    spec, told = remarks(exclusive_goal.check, text)
    for remark in told:
        (goal,) = (each for each in goals(spec) if inner(each.tree).span == remark.labels[0].span)
        formula = goal.formula()
        assert formula and not any(world.traces.ever(formula))
