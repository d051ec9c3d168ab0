"""TLT0487: times behind an event that may have begun before it."""

from __future__ import annotations

import pytest

from tests.tools.lint.helpers import RANGES, accepted_traces, block, codes, findings_in

BEFORE = f"clock 1 Hz\n{RANGES}"


@pytest.mark.parametrize(
    ("clause", "offered"),
    [
        (
            "keep ends a implies not b weak_until time_holding(c) >= 2 s",
            "keep ends a implies not b weak_until (time_holding(c) >= 2 s and time_since(ends a) >= 2 s)",
        ),
        (
            "keep begins a implies eventually within 5 s (time_holding(b) > 2 s)",
            "keep begins a implies eventually within 5 s (time_holding(b) > 2 s and time_since(begins a) > 2 s)",
        ),
    ],
)
def test_a_time_behind_an_event_gets_a_note(clause: str, offered: str) -> None:
    (note,) = (
        item.diagnostic for item in findings_in(block(clause, before=BEFORE)) if item.diagnostic.code == "TLT0487"
    )
    assert note.severity == "note"
    assert f"write `{offered}`" in (note.help or "")
    assert "TLT0487" not in codes(block(offered, before=BEFORE))


def test_the_offered_rule_wants_the_time_after_the_event() -> None:
    before = "clock 1 Hz\nsignal a: bool\nsignal b: bool\nsignal c: bool\n"
    held = "time_holding(c) >= 1 s"
    typed, offered = (
        accepted_traces(block(f"keep ends a implies not b weak_until {end}", before=before), "abc", 3)
        for end in (held, f"({held} and time_since(ends a) >= 1 s)")
    )
    assert ("ac", "bc", "") in typed - offered
    assert offered < typed


@pytest.mark.parametrize(
    "clause",
    [
        "keep a implies not b weak_until time_holding(c) >= 2 s",
        "keep ends a implies not b weak_until time_holding(not a) >= 2 s",
        "keep ends a implies not b weak_until time_holding(c) <= 2 s",
        "keep ends a implies not b weak_until c",
        "keep begins a implies time_holding(c) >= 2 s",
    ],
)
def test_other_rules_get_none(clause: str) -> None:
    assert "TLT0487" not in codes(block(clause, before=BEFORE))
