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


@times(40)
@given(st.integers(1, 4), specs("reach {} then {}", "require X {}", "require {} U ({} then {})"))
def test_no_trace_within_the_limit_satisfies_a_reported_spec(limit: int, drawn: tuple[World, str]) -> None:
    world, text = drawn
    spec, reported = spec_and_findings(short_limit.check, text.replace("limit 9 steps", f"limit {limit} steps"))
    for _ in reported:
        assert not any(world.traces.satisfying(spec.spec.formula)[:limit])
