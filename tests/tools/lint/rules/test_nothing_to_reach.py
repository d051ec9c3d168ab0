"""TLT0420: specs without a goal."""

from __future__ import annotations

import pytest

from tests.tools.lint.helpers import codes


@pytest.mark.parametrize(
    ("clauses", "is_reported"),
    [
        ("reach a", False),
        ("avoid a", True),
        ("judge at limit avoid a", False),
        ("avoid a keep a", False),
        ("require G (a -> F b)", True),
        ("semantics infinite require G (a -> F b)", True),
        ("semantics infinite require G F a", False),
        ("semantics infinite reach a require G F b", False),
    ],
)
def test_specs_without_a_goal_are_reported(clauses: str, is_reported: bool) -> None:
    text = f"signal a: bool signal b: bool let both = a & b\nspec s {{ limit 9 steps {clauses} }}"
    assert ("TLT0420" in codes(text)) == is_reported
