"""TLT0473: `a until eventually within 3 s b`, which may end before b."""

from __future__ import annotations

import pytest

from tests.tools.lint.helpers import SIGNALS, accepted_traces, block, codes, findings_in

BEFORE = f"clock 1 Hz\n{SIGNALS}"


@pytest.mark.parametrize(
    ("clause", "offered"),
    [
        ("require a until eventually within 2 s b", "(a until b) and eventually within 2 s b"),
        ("require a until (eventually within 2 s b)", "(a until b) and eventually within 2 s b"),
        ("keep c implies not a weak_until eventually b", "not a weak_until b"),
        ("require not a until (b then c)", "not a until (c and previously once b)"),
        (
            "keep c implies not a until (b then (c and b) then a)",
            "a and once b",
        ),
        ("require not a until (b then within 2 s c)", "c and once b"),
    ],
)
def test_an_until_that_ends_before_its_goal_gets_another_formula(clause: str, offered: str) -> None:
    text = block(clause, before=BEFORE)
    (warning,) = (item.diagnostic for item in findings_in(text) if item.diagnostic.code == "TLT0473")
    assert warning.severity == "warning"
    assert f"`{offered}`" in (warning.help or "")


def test_the_offered_formula_asks_for_more() -> None:
    typed, offered = (
        accepted_traces(block(f"require {formula}", before=BEFORE), "ab", 3)
        for formula in ("a until eventually within 2 s b", "(a until b) and eventually within 2 s b")
    )
    assert ("", "b", "") in typed - offered
    assert ("a", "a", "b") in offered
    assert offered < typed


def test_the_offered_formula_ends_with_the_last_goal() -> None:
    typed, offered = (
        accepted_traces(block(f"require {formula}", before=BEFORE), "abc", 3)
        for formula in ("not a until (b then c)", "not a until (c and previously once b)")
    )
    assert ("b", "a", "c") in typed - offered
    assert offered < typed


@pytest.mark.parametrize("clause", ["require a until b", "require a until (b and eventually c)", "reach a then b"])
def test_other_formulas_get_none(clause: str) -> None:
    assert "TLT0473" not in codes(block(clause, before=BEFORE))
