"""TLT0428: limits that end the episode before the goal can be reached."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.fuzzing import times
from tests.tools.lint.helpers import SIGNALS, codes, spec_and_findings
from tests.tools.lint.strategies import World, specs
from tltlc.tools.lint.rules import short_limit


@pytest.mark.parametrize(
    ("clauses", "is_reported"),
    [
        ("limit 2 steps reach a then b", False),
        ("limit 1 step reach a then b", True),
        ("limit 2 steps require F[3,5] a", True),
        ("limit 3 steps keep a", False),
    ],
)
def test_limits_that_are_too_short_are_reported(clauses: str, is_reported: bool) -> None:
    assert ("TLT0428" in codes(f"{SIGNALS}spec s {{ {clauses} }}")) == is_reported


@pytest.mark.parametrize(
    ("clause", "least"),
    [
        ("reach time_holding(a) >= 2 s", 21),
        ("reach b and time_holding(a) > 3 s then c", 31),
        ("reach b then (time_holding(a) >= 2 s)", 21),
        ("reach time_holding(a) >= 1 s", None),
        ("reach not (time_holding(a) >= 2 s)", None),
        ("reach b or time_holding(a) >= 2 s", None),
        ("reach time_holding(a) < 2 s", None),
        ("reach time_since(a) >= 2 s", None),
    ],
)
def test_a_goal_that_takes_longer_than_the_limit_is_reported(clause: str, least: int | None) -> None:
    text = f"clock 10 Hz {SIGNALS}spec s {{ limit 20 steps {clause} }}"
    _, reported = spec_and_findings(short_limit.check, text)
    assert [finding.help for finding in reported] == (
        [] if least is None else [f"allow more: at least `limit {least} steps`"]
    )
    assert "TLT0428" not in codes(text.replace("10 Hz", "varies"))


@times(40)
@given(st.integers(1, 4), specs("reach {} then {}", "require X {}", "require {} U ({} then {})"))
def test_no_trace_within_the_limit_satisfies_a_reported_spec(limit: int, drawn: tuple[World, str]) -> None:
    world, text = drawn
    spec, reported = spec_and_findings(short_limit.check, text.replace("limit 9 steps", f"limit {limit} steps"))
    for _ in reported:
        assert not any(world.traces.satisfying(spec.spec.formula)[:limit])
