"""TLT0475: limits of the time since an event that a state breaks before the first event."""

from __future__ import annotations

import pytest

from tests.tools.lint.helpers import SIGNALS, block, codes, findings_in

BEFORE = f"clock 1 Hz\n{SIGNALS}signal mode: (walk, run)\n"


@pytest.mark.parametrize(
    ("clause", "offered"),
    [
        ("keep mode is run implies time_since(a) <= 20 s", "avoid time_holding(mode is run and not a) > 20 s"),
        (
            "keep mode is run implies time_since(a or b) < 2 s",
            "avoid time_holding(mode is run and not (a or b)) >= 2 s",
        ),
        ("avoid mode is run and time_since(a) > 20 s", "avoid time_holding(mode is run and not a) > 20 s"),
        ("avoid time_since(a) >= 20 s and mode is run", "avoid time_holding(mode is run and not a) >= 20 s"),
    ],
)
def test_a_limit_while_a_state_holds_gets_a_note(clause: str, offered: str) -> None:
    findings = findings_in(block(clause, before=BEFORE))
    (note,) = (item.diagnostic for item in findings if item.diagnostic.code == "TLT0475")
    assert note.severity == "note"
    assert f"`{offered}`" in (note.help or "")


@pytest.mark.parametrize(
    "clause",
    [
        "keep a implies time_since(b) <= 20 s",
        "keep begins mode is run implies a",
        "keep mode is run and once a implies time_since(a) <= 20 s",
        "keep mode is run implies time_since(a) >= 20 s",
        "avoid mode is run and time_since(a) < 20 s",
    ],
)
def test_other_rules_get_none(clause: str) -> None:
    assert "TLT0475" not in codes(block(clause, before=BEFORE))
