"""TLT0486: exceptions from limits on the last seconds that count at their own step alone."""

from __future__ import annotations

import pytest

from tests.tools.lint.helpers import RANGES, accepted_traces, block, codes, findings_in

BEFORE = f"clock 1 Hz\n{RANGES}"


@pytest.mark.parametrize(
    ("clause", "offered"),
    [
        (
            "keep x >= highest_within(x, 2 s) - 0.5 or a",
            "keep x >= highest_within(x, 2 s) - 0.5 or once within 2 s a",
        ),
        (
            "keep a or b or times_within(c, 3 s) <= 1",
            "keep times_within(c, 3 s) <= 1 or once within 3 s (a or b)",
        ),
        (
            "keep a implies (x <= previous(x, 2 s) + 0.5 or begins b)",
            "keep a implies (x <= previous(x, 2 s) + 0.5 or once within 2 s begins b)",
        ),
    ],
)
def test_an_exception_of_one_step_gets_a_note(clause: str, offered: str) -> None:
    (note,) = (
        item.diagnostic for item in findings_in(block(clause, before=BEFORE)) if item.diagnostic.code == "TLT0486"
    )
    assert note.severity == "note"
    assert f"write `{offered}`" in (note.help or "")
    assert "TLT0486" not in codes(block(offered, before=BEFORE))


def test_the_offered_rule_excuses_what_came_with_the_exception() -> None:
    before = "clock 1 Hz\nsignal a: bool\nsignal b: bool\n"
    typed, offered = (
        accepted_traces(block(f"keep times_within(b, 3 s) <= 1 or {excuse}", before=before), "ab", 4)
        for excuse in ("a", "once within 3 s a")
    )
    assert ("b", "", "ab", "") in offered - typed
    assert typed < offered


@pytest.mark.parametrize(
    "clause",
    [
        "keep x >= highest_within(x, 2 s) - 0.5 or once within 2 s a",
        "keep x >= highest_within(x, 2 s) - 0.5 or x > 0.5",
        "keep x >= previous(x) or a",
        "keep time_holding(b) <= 2 s or a",
        "avoid times_within(b, 2 s) > 1 and not a",
        "keep times_within(b, 2 s) <= 1 or times_within(c, 2 s) <= 1",
    ],
)
def test_other_rules_get_none(clause: str) -> None:
    assert "TLT0486" not in codes(block(clause, before=BEFORE))
