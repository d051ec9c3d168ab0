"""TLT0484: rules that ask for a change at each step of a state that may last."""

from __future__ import annotations

import pytest

from tests.tools.lint.helpers import SIGNALS, block, codes, findings_in

BEFORE = f"clock 1 Hz\n{SIGNALS}signal n: int in [0, 9]\nsignal k: int in [0, 9]\nsignal mode: (idle, alert)\n"


@pytest.mark.parametrize(
    ("clause", "offered"),
    [
        ("keep n == 0 implies k == previous(k) - 1", "keep begins (n == 0) implies k == previous(k) - 1"),
        (
            "keep mode is alert implies weak_next k == previous(k) + 2",
            "keep begins (mode is alert) implies weak_next k == previous(k) + 2",
        ),
        ("keep (n == 0) implies (k == previous(k) + 1)", "keep begins (n == 0) implies (k == previous(k) + 1)"),
        ("keep n > 3 implies previous(k) - 1 == k", "keep begins (n > 3) implies previous(k) - 1 == k"),
        ("require always (n > 3 implies k == previous(k) + 1)", "begins (n > 3)"),
    ],
)
def test_a_change_in_a_state_gets_a_note(clause: str, offered: str) -> None:
    notes = [item.diagnostic for item in findings_in(block(clause, before=BEFORE))]
    (note,) = (note for note in notes if note.code == "TLT0484")
    assert note.severity == "note"
    assert f"write `{offered}`" in (note.help or "")


@pytest.mark.parametrize(
    "clause",
    [
        "keep a implies k == previous(k) - 1",
        "keep begins (n == 0) implies k == previous(k) - 1",
        "keep n == 0 implies k >= previous(k) - 1",
        "keep n == 0 implies k == previous(k)",
        "keep n > previous(n) implies k == previous(k) - 1",
        "keep times(a, 9) == 2 implies k == previous(k) - 1",
    ],
)
def test_other_rules_get_none(clause: str) -> None:
    assert "TLT0484" not in codes(block(clause, before=BEFORE))
