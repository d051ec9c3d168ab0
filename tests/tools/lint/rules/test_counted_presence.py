"""TLT0469: counts that are compared with 1 or 0, where any step may be meant."""

from __future__ import annotations

import pytest

from tests.tools.lint.helpers import SIGNALS, accepted_traces, block, codes, findings_in

BEFORE = f"clock 1 Hz\n{SIGNALS}"


@pytest.mark.parametrize(
    ("clause", "offered"),
    [
        ("keep c implies times_since(a, begins b) >= 1", "(not begins b since a)"),
        ("keep c implies times_since(a, b) > 0", "(not b since a)"),
        ("keep c implies times_since(a or c, b) == 0", "not (not b since (a or c))"),
        ("keep c implies times_within(a, 3 s) >= 1", "once within 3 s a"),
        ("avoid c and times_within(a, 3 s) < 1", "not (once within 3 s a)"),
    ],
)
def test_a_count_that_asks_for_one_gets_a_note(clause: str, offered: str) -> None:
    text = block(clause, before=BEFORE)
    (note,) = (item.diagnostic for item in findings_in(text) if item.diagnostic.code == "TLT0469")
    assert note.severity == "note"
    assert f"`{offered}`" in (note.help or "")


def test_the_offered_condition_holds_at_steps_that_the_count_does_not_have() -> None:
    typed, offered = (
        accepted_traces(block(f"keep b implies {condition}", before=BEFORE), "abc", 3)
        for condition in ("times_since(a, begins c) >= 1", "(not begins c since a)")
    )
    # a has begun before c, and holds on.
    assert ("a", "ac", "ab") in offered - typed
    assert ("", "ac", "bc") in offered & typed


@pytest.mark.parametrize(
    "clause",
    [
        "keep c implies times_since(begins a, b) >= 1",
        "keep c implies times_since(a, b) >= 2",
        "keep c implies times(a) >= 1",
        "keep times_since(a, b) <= 0",
        "keep times_since(a, b) >= 1",
    ],
)
def test_other_counts_get_none(clause: str) -> None:
    assert "TLT0469" not in codes(block(clause, before=BEFORE))
