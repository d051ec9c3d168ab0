"""TLT0417: goals without a slope."""

from __future__ import annotations

import pytest
from hypothesis import given

from tests.tools.lint.helpers import block, of, remarks
from tests.tools.lint.predicates import PREDICATES, Predicate
from tltlc.tools.lint.rules import flat_goal


@pytest.mark.parametrize(
    ("clauses", "expected"),
    [
        (("reach alive",), ["alive"]),
        (("reach a then alive",), ["alive"]),
        (("keep alive",), []),
        (("reach a", "keep alive"), []),
        (("reach not alive",), []),
        (("reach a and alive",), []),
        (("reach (a and alive) or (b and alive)",), []),
        (("reach a or alive",), []),
        (("reach alive and not a",), ["alive"]),
        (("reach alive and full",), ["alive", "full"]),
    ],
)
def test_goals_without_a_slope(clauses: tuple[str, ...], expected: list[str]) -> None:
    before = "import stealth\nsignal a: bool signal b: bool\npredicate full in [0, 1] = max(0, 2 * health - 1)\n"
    assert of("TLT0417", *clauses, before=before) == expected


@given(PREDICATES)
def test_the_value_is_0_where_the_atom_does_not_hold_and_it_may_not_hold(predicate: Predicate) -> None:
    _, told = remarks(flat_goal.check, block("reach p", before=predicate.declared))
    for _ in told:
        assert min(predicate.values()) == 0
