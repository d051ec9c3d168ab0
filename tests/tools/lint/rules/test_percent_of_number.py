"""TLT0438: percentages beside numbers that are no shares."""

from __future__ import annotations

import pytest

from tests.tools.lint.helpers import findings_in
from tltlc.pipeline import compile_text

SIGNALS = """
entity e
signal health: int in [0, 100]
signal coins in [0, 50]
signal hp(x: entity) in [0, 100]
signal share: ratio
signal percent in [0 %, 100 %]
signal load in [0, 2]
signal depth in [-100, 100]
signal height: length in [0 m, 100 m]
param least in [0, 100] = 20
"""


def helps(clause: str, rest: str = "") -> list[str]:
    text = f"{SIGNALS}spec s {{\n    limit 300 steps\n    {clause}\n}}\n{rest}"
    diagnostics = (finding.diagnostic for finding in findings_in(text))
    return [diagnostic.help or "" for diagnostic in diagnostics if diagnostic.code == "TLT0438"]


@pytest.mark.parametrize(
    ("clause", "meant", "share"),
    [
        ("keep health > 40 %", "40", "0.4"),
        ("keep 40% < hp(e)", "40", "0.4"),
        ("reach coins >= (30%)", "15", "0.3"),
        ("keep share > 30 % or hp(e) <= 12.5 %", "12.5", "0.125"),
        ("reach all x in (e): hp(x) > 70%", "70", "0.7"),
    ],
)
def test_a_percentage_of_a_wide_range_is_reported(clause: str, meant: str, share: str) -> None:
    (help_,) = helps(clause)
    assert help_.startswith(f"write `{meant}`")
    assert help_.endswith(f"or `{share}` if that is meant")
    percentage = next(word for word in ("40 %", "40%", "(30%)", "12.5 %", "70%") if word in clause)
    for text in (meant, share):
        compile_text(f"{SIGNALS}spec s {{ {clause.replace(percentage, text)} }}")
        assert helps(clause.replace(percentage, text)) == []


@pytest.mark.parametrize(
    "clause",
    ["keep share > 40 %", "keep percent > 40 %", "keep load > 40 %", "keep depth > 40 %", "keep health > 40"],
)
def test_a_share_is_not_reported(clause: str) -> None:
    assert helps(clause) == []


def test_predicates_params_and_tests_are_looked_at() -> None:
    predicate = "predicate weak = when health < 40 %: 1 otherwise: -1\n"
    step = 'test "t" for s { step health = 4, coins = 40 % expect pending }\n'
    assert len(helps("reach weak and coins > 3", predicate + step)) == 2
    assert len(helps("reach health > 3", "let poor = least < 5 %\n")) == 1
