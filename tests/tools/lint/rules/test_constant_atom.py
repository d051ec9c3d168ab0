"""TLT0416: atoms that are always true or always false."""

from __future__ import annotations

import pytest
from hypothesis import given

from tests.fuzzing import times
from tests.tools.lint.helpers import block, codes, findings_in, spec_and_findings
from tests.tools.lint.predicates import PREDICATES, Predicate
from tltlc.tools.lint.rules import constant_atom


@pytest.mark.parametrize(
    ("predicate", "expected"),
    [
        ("[0, 1] = x / 10", []),
        ("[-1, 0] = -x / 10", ["never"]),
        ("[-1, 0] = x / 10 - 1", ["never"]),
        ("[-1, 1] = x / 10 - 0.5", []),
        ("[0, 1] = (x + 1) / 11", ["always"]),
        ("[-1, 1] = when x > 5: -0.5 otherwise: -1", ["never"]),
        ("[-1, 1] = when x > 5: 0.5 otherwise: -1", []),
        ("[-1, 1] = when x > 11: 1 otherwise: -1", ["never"]),
        ("[-1, 1] = when x >= 10: 1 otherwise: -1", []),
        ("[0, 1] = (x / 10)^2", []),
        ("[-1, 0] = -(x / 10)^2", ["never"]),
        ("[-1, 1] = min(x / 10 - 0.5, 0.5 - x / 10)", ["never"]),
    ],
)
def test_constant_atoms_are_reported(predicate: str, expected: list[str]) -> None:
    before = f"signal x in [0, 10]\npredicate p in {predicate}\n"
    titles = [
        finding.diagnostic.title
        for finding in findings_in(block("reach p", before=before))
        if finding.diagnostic.code == "TLT0416"
    ]
    assert titles == [f"`p` {frequency} holds" for frequency in expected]


def test_an_atom_is_reported_once_per_file() -> None:
    before = "signal x in [0, 10]\npredicate p in [-1, 0] = -x / 10\n"
    assert codes(before + "spec one = F p\nspec two = G !p\n") == ["TLT0416"]


@times(40)
@given(PREDICATES)
def test_reported_atoms_are_constant_on_all_values(predicate: Predicate) -> None:
    _, reported = spec_and_findings(constant_atom.check, block("reach p", before=predicate.declaration))
    for finding in reported:
        truths = {value > 0 for value in predicate.values()}
        assert truths == {finding.title == "`p` always holds"}
