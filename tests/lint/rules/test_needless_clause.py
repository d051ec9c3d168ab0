"""TLT0430: clauses that every trace satisfies."""

from __future__ import annotations

import pytest
from hypothesis import given

from tests.lint.helpers import APART, PLACES, RANGES, of, remarks
from tests.lint.strategies import World, specs
from tltlc.lint.rules import needless_clause


@pytest.mark.parametrize(
    ("clauses", "expected"),
    [
        (("reach a", "keep x > 3 or x < 5"), ["keep x > 3 or x < 5"]),
        (("reach a", "avoid x > 5 and x < 3"), ["avoid x > 5 and x < 3"]),
        (("reach a", "avoid x > 5 and not x > 3"), ["avoid x > 5 and not x > 3"]),
        (("reach a", "require always (x > 5 implies x > 3)"), ["always (x > 5 implies x > 3)"]),
        (("reach a", "keep b or not b"), ["keep b or not b"]),
        (("reach a", "reach b or not b"), ["reach b or not b"]),
        (("reach a", "require b or not b"), ["b or not b"]),
        (("reach a", "avoid x + y > 15 and x < 4"), ["avoid x + y > 15 and x < 4"]),
        (("semantics infinite", "require G F a", "keep x > 3 or x < 5"), ["keep x > 3 or x < 5"]),
        (("reach a", "keep x > 5 or x < 3"), []),
        (("reach a", "keep x > 3 or x < 3"), []),
        (("reach a", "keep x > 3 or y < 5"), []),
        (("reach a", "avoid x + y > 13 and x < 4"), []),
        (("reach a", "avoid x > 3 and x < 5"), []),
        (("reach a", "keep b or not c"), []),
        # Of what the compiler says of the whole spec nothing more is said.
        (("reach b or not b",), []),
    ],
)
def test_clauses_that_nothing_breaks(clauses: tuple[str, ...], expected: list[str]) -> None:
    assert of("TLT0430", *clauses, before=RANGES) == expected


def test_what_is_exclusive_cannot_be_broken() -> None:
    assert of("TLT0430", "reach at(z)", "avoid at(x) and at(y)", before=APART) == ["avoid at(x) and at(y)"]
    assert of("TLT0430", "reach at(z)", "avoid at(x) and at(y)", before=PLACES) == []


@given(specs("keep {}", "avoid {}", "reach {}", "require {}"))
def test_no_trace_breaks_it(drawn: tuple[World, str]) -> None:
    world, text = drawn
    spec, told = remarks(needless_clause.check, text)
    for remark in told:
        (formula,) = (part.formula for part in spec.spec.parts if part.span == remark.labels[0].span)
        assert world.traces.satisfying(formula) == world.traces.every
