"""TLT0433: of `a until b` at some step, or at no step, b alone is asked for."""

from __future__ import annotations

import pytest
from hypothesis import given

from tests.tools.lint.helpers import SIGNALS, codes, remarks
from tests.tools.lint.strategies import FREE, World, specs
from tltlc.automaton.compare import are_equivalent
from tltlc.pipeline import compile_text
from tltlc.tools.lint.rules import idle_until


@pytest.mark.parametrize(
    ("clause", "same"),
    [
        ("reach a until b", "reach b"),
        ("avoid a until b", "avoid b"),
        ("reach c then (a until b)", "reach c then b"),
        ("avoid (a or c) until b", "avoid b"),
    ],
)
def test_the_first_half_has_no_say(clause: str, same: str) -> None:
    assert "TLT0433" in codes(spec(clause))
    written, simple = (compile_text(spec(each))[0] for each in (clause, same))
    assert are_equivalent(written, simple)


@pytest.mark.parametrize(
    "clause",
    ["reach (a until b) then c", "require a until b", "reach a and (c until b)", "reach a weak_until b", "avoid b"],
)
def test_where_it_has_one(clause: str) -> None:
    assert "TLT0433" not in codes(spec(clause))


@pytest.mark.parametrize(
    ("clause", "offered"),
    [
        ("avoid a until b", "require (not a) weak_until b"),
        ("avoid (a or c) until b", "require (not (a or c)) weak_until b"),
        ("reach a until b", "require a until b"),
    ],
)
def test_what_is_offered_has_a_goal_where_the_clause_has_one(clause: str, offered: str) -> None:
    (remark,) = remarks(idle_until.check, spec(clause))[1]
    assert remark.help == f"say `{offered}`"
    written, other = (compile_text(spec(each))[0] for each in (clause, offered))
    assert written.judge == other.judge


def spec(clause: str) -> str:
    return f"{SIGNALS}spec s {{\n    limit 300 steps\n    {clause}\n}}\n"


@given(specs("reach {} until {}", "avoid {} until {}", "reach {} then ({} until {})", worlds=[FREE], most=1))
def test_what_is_said_of_the_clause_is_the_same(drawn: tuple[World, str]) -> None:
    world, text = drawn
    spec, told = remarks(idle_until.check, text)
    for remark in told:
        span = remark.labels[0].span
        _, goal = remark.labels[0].message.split("`")[1].split(" ", 1)
        same, _ = remarks(idle_until.check, f"{text[: span.start]}({goal}){text[span.end :]}")
        assert world.traces.satisfying(spec.spec.formula) == world.traces.satisfying(same.spec.formula)
