"""TLT0485: counts of all of play as goals behind other goals."""

from __future__ import annotations

import pytest

from tests.tools.lint.helpers import accepted_traces, block, codes, findings_in


@pytest.mark.parametrize(
    ("clause", "offered"),
    [
        ("reach a then times(b) >= 3", "times_since(b, begins a) >= 3"),
        ("reach a then c then times(b, 9) > 2", "times_since(b, begins c, 9) > 2"),
        ("reach a then (times(b) == 2 and c)", "times_since(b, begins a) == 2"),
        ("reach (a and c) then times(b) >= 2 then a", "times_since(b, begins (a and c)) >= 2"),
    ],
)
def test_a_count_behind_a_goal_gets_a_note(clause: str, offered: str) -> None:
    (note,) = (item.diagnostic for item in findings_in(block(clause)) if item.diagnostic.code == "TLT0485")
    assert note.severity == "note"
    assert f"write `{offered}`" in (note.help or "")


def test_the_offered_goal_needs_those_after_the_goal_before() -> None:
    typed, offered = (
        accepted_traces(block(f"reach a then {count} >= 2"), "ab", 4)
        for count in ("times(b)", "times_since(b, begins a)")
    )
    assert ("b", "", "ab", "") in typed - offered
    assert offered < typed


@pytest.mark.parametrize(
    "clause",
    [
        "reach times(b) >= 3 then a",
        "reach a then times_since(b, a) >= 3",
        "reach a then times(a) >= 3",
        "reach times(a) >= 3 then times(a and b) >= 2",
        "reach a then times(b) <= 3",
        "avoid a then times(b) >= 3",
    ],
)
def test_other_goals_get_none(clause: str) -> None:
    assert "TLT0485" not in codes(block(clause))
