"""TLT0468: `always for 3 s a until b`, which no time ends."""

from __future__ import annotations

import pytest

from tests.tools.lint.helpers import SIGNALS, accepted_traces, block, codes, findings_in

BEFORE = f"clock 1 Hz\n{SIGNALS}"


@pytest.mark.parametrize(
    ("clause", "offered"),
    [
        ("keep c implies always for 2 s a weak_until b", "((always for 2 s a) or (a until b))"),
        ("keep c implies always for 2 s a until b", "((always for 2 s a) or (a until b))"),
        ("keep c implies always for 2 s (a and c) until b", "((always for 2 s (a and c)) or ((a and c) until b))"),
        ("require (always for 2 s a) until begins b", "((always for 2 s a) or (a until begins b))"),
    ],
)
def test_a_time_before_until_gets_another_formula(clause: str, offered: str) -> None:
    text = block(clause, before=BEFORE)
    (warning,) = (item.diagnostic for item in findings_in(text) if item.diagnostic.code == "TLT0468")
    assert warning.severity == "warning"
    assert f"`{offered}`" in (warning.help or "")
    assert not {"TLT0446", "TLT0448"} & {*codes(text)}


def test_the_offered_formula_is_over_after_the_time() -> None:
    typed, offered = (
        accepted_traces(block(f"require {formula}", before=BEFORE), "ab", 4)
        for formula in ("(always for 2 s a) weak_until b", "(always for 2 s a) or (a until b)")
    )
    assert ("a", "a", "a", "") in offered - typed
    assert ("a", "b", "", "") in offered - typed
    assert typed < offered


@pytest.mark.parametrize(
    "clause", ["keep c implies a until b", "keep c implies (always for 2 s a) or (a until b)", "keep always for 2 s a"]
)
def test_other_formulas_get_none(clause: str) -> None:
    assert "TLT0468" not in codes(block(clause, before=BEFORE))
