"""Linting a whole file."""

from __future__ import annotations

import pytest

from tests.lint.helpers import codes


@pytest.mark.parametrize(
    "formula",
    [
        " -> ".join(["a"] * 900),
        " U ".join(["a"] * 900),
        "F " * 990 + "a",
        "X " * 900 + "a",
        "F (" + "!" * 900 + "a -> b)",
    ],
    ids=lambda formula: formula[:6],
)
def test_long_formulas_are_linted(formula: str) -> None:
    assert set(codes(f"signal a: bool signal b: bool let both = a & b spec x = {formula}")) >= {"TLT0421"}
