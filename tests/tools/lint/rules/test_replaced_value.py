"""TLT0464: values since an event that an answer asks for at a later step."""

from __future__ import annotations

import pytest

from tests.tools.lint.helpers import SIGNALS, block, codes, findings_in

BEFORE = f"clock 1 Hz\n{SIGNALS}signal coins in [0, 9]\n"


@pytest.mark.parametrize(
    ("answer", "call"),
    [
        ("eventually within 3 s coins <= value_at(coins, begins b)", "value_at(coins, begins b)"),
        ("next (coins < 3 or times_since(a, b) >= 2)", "times_since(a, b)"),
        ("(c weak_until coins > highest_since(coins, b))", "highest_since(coins, b)"),
    ],
)
def test_a_value_since_an_event_at_a_later_step_gets_a_finding(answer: str, call: str) -> None:
    clause = f"keep ends b implies {answer}"
    (finding,) = (
        item.diagnostic for item in findings_in(block(clause, before=BEFORE)) if item.diagnostic.code == "TLT0464"
    )
    assert finding.severity == "note"
    label = finding.labels[0]
    assert label.source.slice(label.span) == call


@pytest.mark.parametrize(
    "clause",
    [
        "keep ends b implies coins <= value_at(coins, begins b)",
        "keep b implies coins <= value_at(coins, begins b) + 2",
        "keep coins > value_at(coins, begins b) implies eventually within 3 s a",
        "reach coins > value_at(coins, begins b) + 2",
    ],
)
def test_values_at_the_step_itself_get_none(clause: str) -> None:
    assert "TLT0464" not in codes(block(clause, before=BEFORE))
