"""TLT0470: counts since a condition began, which go on after it."""

from __future__ import annotations

import pytest

from tests.tools.lint.helpers import SIGNALS, accepted_traces, block, codes, findings_in

BEFORE = f"clock 1 Hz\n{SIGNALS}signal mode: (idle, alert)\n"


@pytest.mark.parametrize(
    ("rule", "state"),
    [
        ("times_since(a, begins b) <= 1", "b"),
        ("times_since(a, begins mode is alert) < 2", "mode is alert"),
        ("total_time_since(a, begins (b and c)) <= 2 s", "(b and c)"),
        ("times_since(a, ends b) <= 1", "not b"),
    ],
)
def test_a_limit_since_a_beginning_gets_a_note(rule: str, state: str) -> None:
    (note,) = (
        item.diagnostic
        for item in findings_in(block(f"keep {rule}", before=BEFORE))
        if item.diagnostic.code == "TLT0470"
    )
    assert note.severity == "note"
    assert f"`keep {state} implies {rule}`" in (note.help or "")


def test_the_offered_rule_allows_what_comes_later() -> None:
    typed, offered = (
        accepted_traces(block(f"keep {rule}times_since(a, begins b) <= 1", before=f"clock 1 Hz\n{SIGNALS}"), "ab", 4)
        for rule in ("", "b implies ")
    )
    assert ("ab", "", "a", "") in offered - typed
    assert typed < offered


@pytest.mark.parametrize(
    "clause",
    [
        "keep b implies times_since(a, begins b) <= 1",
        "keep times_since(a and b, begins b) <= 1",
        "keep times_since(a, b) <= 1",
        "reach times_since(a, begins b) <= 1",
        "keep c implies times_since(a, begins b) <= 1",
        "keep times_since(mode is alert, begins mode is alert) <= 1",
    ],
)
def test_other_limits_get_none(clause: str) -> None:
    assert "TLT0470" not in codes(block(clause, before=BEFORE))
