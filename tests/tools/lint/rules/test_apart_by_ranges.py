"""TLT0431: clauses that contradict each other because of the ranges of signals."""

from __future__ import annotations

import pytest
from hypothesis import given

from tests.fuzzing import times
from tests.tools.lint.helpers import RANGES, labelled_texts_in_block, spec_and_findings
from tests.tools.lint.strategies import RANGED, World, specs
from tltlc.tools.lint.rules import apart_by_ranges


@pytest.mark.parametrize(
    ("clauses", "expected"),
    [
        (("reach a", "keep x > 5", "avoid x > 3"), ["keep x > 5"]),
        (("reach a", "keep x > 5", "keep x < 3"), ["keep x > 5"]),
        (("reach x > 5 and x < 3",), ["reach x > 5 and x < 3"]),
        (("semantics infinite", "require G F (x > 5 & x < 3)"), ["G F (x > 5 & x < 3)"]),
        (("reach a", "keep x > 5", "avoid x > 7"), []),
        (("reach x > 5", "reach x < 3"), []),
        (("reach x > 5 then x < 3",), []),
        (("reach a", "keep x > 5", "keep y < 3"), []),
        (("reach a", "avoid a"), []),
    ],
)
def test_clauses_that_contradict_each_other_by_ranges_are_reported(
    clauses: tuple[str, ...], expected: list[str]
) -> None:
    assert labelled_texts_in_block("TLT0431", *clauses, before=RANGES) == expected


@times(40)
@given(specs("keep {}", "avoid {}", "reach {}", "require {}", worlds=[RANGED]))
def test_no_trace_of_values_satisfies_a_reported_spec(drawn: tuple[World, str]) -> None:
    world, text = drawn
    spec, reported = spec_and_findings(apart_by_ranges.check, text)
    for _ in reported:
        assert not any(world.traces.satisfying(spec.spec.formula))
