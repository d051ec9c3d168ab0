"""TLT0417: goals whose value gives no gradient."""

from __future__ import annotations

import pytest
from hypothesis import given

from tests.fuzzing import times
from tests.tools.lint.helpers import block, labelled_texts_in_block, spec_and_findings
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
def test_flat_goals_are_reported(clauses: tuple[str, ...], expected: list[str]) -> None:
    before = "import stealth\nsignal a: bool signal b: bool\npredicate full in [0, 1] = max(0, 2 * health - 1)\n"
    assert labelled_texts_in_block("TLT0417", *clauses, before=before) == expected


@times(40)
@given(PREDICATES)
def test_a_reported_atom_is_0_wherever_it_is_false(predicate: Predicate) -> None:
    _, reported = spec_and_findings(flat_goal.check, block("reach p", before=predicate.declaration))
    for _ in reported:
        assert min(predicate.values()) == 0
