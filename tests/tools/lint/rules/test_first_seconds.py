"""TLT0442: clauses about the first seconds of play."""

from __future__ import annotations

import pytest

from tests.tools.lint.helpers import findings_in
from tltlc.diagnostics.diagnostic import Diagnostic

CASES = {
    "require always for 3 s a": "for every step, write `keep a`; "
    "for 3 s at some time, write `reach time_holding(a) >= 3 s`",
    "require (always for 500 ms (a or b))": "for every step, write `keep a or b`; "
    "for 500 ms at some time, write `reach time_holding(a or b) >= 500 ms`",
    "require c and always for 3 steps not a": "for every step, write `keep not a`",
}


def found(clause: str) -> list[Diagnostic]:
    text = f"clock 60 Hz signal a: bool signal b: bool signal c: bool\nspec s {{ judge at limit limit 9 s {clause} }}\n"
    return [finding.diagnostic for finding in findings_in(text) if finding.diagnostic.code == "TLT0442"]


@pytest.mark.parametrize(("clause", "advice"), CASES.items(), ids=CASES)
def test_a_time_from_the_first_step_is_noted(clause: str, advice: str) -> None:
    (diagnostic,) = found(clause)
    assert (diagnostic.severity, diagnostic.help) == ("note", advice)
    # Each form that the advice names compiles, and has no such finding.
    for form in str(diagnostic.help).split("`")[1::2]:
        assert found(form) == []


@pytest.mark.parametrize(
    "clause",
    [
        "keep a implies always for 3 s b",
        "require not always for 3 s a",
        "require always for 3 s (a implies b)",
        "require always for 3 s eventually a",
        "require eventually within 3 s a",
        "require a or always for 3 s b",
        "require always a",
        "require G[0,3] a",
    ],
)
def test_other_clauses_are_not_noted(clause: str) -> None:
    assert found(clause) == []


def test_a_spec_of_one_formula_is_not_noted() -> None:
    findings = findings_in("clock 60 Hz signal a: bool\nspec s = always for 3 s a\n")
    assert "TLT0442" not in [finding.diagnostic.code for finding in findings]
