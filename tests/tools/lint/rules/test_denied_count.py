"""TLT0471: rules that forbid what their condition counts, at the very step of the count."""

from __future__ import annotations

import pytest

from tests.tools.lint.helpers import SIGNALS, accepted_traces, block, codes, findings_in

BEFORE = f"clock 1 Hz\n{SIGNALS}"


@pytest.mark.parametrize(
    ("rule", "offered"),
    [
        (
            "times(a) >= 2 implies always for 2 s not a",
            "begins (times(a) >= 2) implies weak_next (always for 2 s not begins a)",
        ),
        (
            "times_within(a, 3 s) == 2 implies always not a",
            "begins (times_within(a, 3 s) == 2) implies weak_next (always not begins a)",
        ),
        (
            "begins (times_within(a, 3 s) >= 2) implies always for 2 s not a",
            "begins (times_within(a, 3 s) >= 2) implies weak_next (always for 2 s not begins a)",
        ),
        (
            "begins times(begins a) >= 2 implies always for 2 s not begins a",
            "begins times(begins a) >= 2 implies weak_next (always for 2 s not begins a)",
        ),
        ("times(a and b) > 1 implies (not (a and b)) weak_until c", "begins (times(a and b) > 1) implies weak_next "),
        ("times_since(a, b) >= 2 implies not a", "previously (times_since(a, b) >= 2) implies not begins a"),
    ],
)
def test_a_count_that_forbids_what_it_counts_gets_a_warning(rule: str, offered: str) -> None:
    text = block(f"keep {rule}", before=BEFORE)
    (warning,) = (item.diagnostic for item in findings_in(text) if item.diagnostic.code == "TLT0471")
    assert warning.severity == "warning"
    assert f"`keep {offered}" in (warning.help or "")


def test_the_offered_rule_allows_the_last_one_that_is_counted() -> None:
    typed, offered = (
        accepted_traces(block(f"keep {rule}", before=BEFORE), "a", 5)
        for rule in ("times(a) >= 2 implies not a", "previously (times(a) >= 2) implies not begins a")
    )
    assert ("a", "", "a", "") in offered - typed
    assert ("a", "", "a", "a") in offered
    assert ("a", "", "a", "", "a") not in offered | typed


@pytest.mark.parametrize(
    "rule",
    [
        "times(a) >= 2 implies not b",
        "times(a) <= 2 implies not a",
        "times(a) >= 2 implies eventually not a",
        "begins (times(a) >= 2) implies weak_next not a",
        "begins (times(a) >= 2) implies weak_next (always for 2 s not begins a)",
    ],
)
def test_other_rules_get_none(rule: str) -> None:
    assert "TLT0471" not in codes(block(f"keep {rule}", before=BEFORE))
