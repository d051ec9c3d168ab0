"""TLT0477: rules that something has held for a time, which no step in the first seconds keeps."""

from __future__ import annotations

import pytest

from tests.tools.lint.helpers import SIGNALS, accepted_traces, block, codes, findings_in

BEFORE = f"clock 1 Hz\n{SIGNALS}signal mode: (walk, run)\n"


@pytest.mark.parametrize(
    ("clause", "offered"),
    [
        ("keep mode is run implies time_holding(a) >= 2 s", "historically for 2 s a"),
        ("keep mode is run and b implies time_holding(a or c) >= 2 s", "historically for 2 s (a or c)"),
    ],
)
def test_a_time_while_a_state_holds_gets_a_note(clause: str, offered: str) -> None:
    findings = findings_in(block(clause, before=BEFORE))
    (note,) = (item.diagnostic for item in findings if item.diagnostic.code == "TLT0477")
    assert note.severity == "note"
    assert f"`{offered}`" in (note.help or "")


def test_the_offered_formula_asks_for_no_more_than_there_is() -> None:
    before = "clock 1 Hz signal a: bool signal b: bool\n"
    typed, offered = (
        accepted_traces(block(f"keep b implies {formula}", before=before), "ab", 4)
        for formula in ("time_holding(a) >= 2 s", "historically for 2 s a")
    )
    assert ("a", "ab") in offered - typed
    assert typed < offered
    assert ("", "ab") not in offered


@pytest.mark.parametrize(
    "clause",
    [
        "keep b implies time_holding(a) >= 2 s",
        "keep mode is run and previously mode is walk implies time_holding(a) >= 2 s",
        "keep mode is run implies time_holding(a) <= 2 s",
    ],
)
def test_other_rules_get_none(clause: str) -> None:
    assert "TLT0477" not in codes(block(clause, before=BEFORE))
