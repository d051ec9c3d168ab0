"""TLT0472: rules that ask for a change at each step with a condition, and so at a first step."""

from __future__ import annotations

import pytest

from tests.tools.lint.helpers import RANGES, accepted_traces, block, codes, findings_in

BEFORE = f"clock 1 Hz\n{RANGES}signal n: int in [0, 9]\nsignal mode: (walk, run)\n"


@pytest.mark.parametrize(
    ("clause", "offered"),
    [
        ("keep a implies x > previous(x)", "keep a and previously true implies x > previous(x)"),
        ("keep a and b implies n != previous(n)", "keep a and b and previously true implies n != previous(n)"),
        ("keep a or b implies previous(x) > x", "keep (a or b) and previously true implies previous(x) > x"),
        ("require always (a implies x < previous(x))", "and previously true"),
        ("keep a implies b and x > previous(x)", "and previously true"),
        ("keep a implies (b implies x > previous(x))", "and previously true"),
        ("keep a implies n == previous(n) - 1", "keep a and previously true implies n == previous(n) - 1"),
        ("keep a implies n >= previous(n) + 2", "keep a and previously true implies n >= previous(n) + 2"),
        ("keep a implies previous(n) - 2 > n", "keep a and previously true implies previous(n) - 2 > n"),
        (
            "keep begins mode is run implies previously mode is walk",
            "keep begins mode is run and previously true implies previously mode is walk",
        ),
    ],
)
def test_a_change_that_a_condition_asks_for_gets_a_note(clause: str, offered: str) -> None:
    text = block(clause, before=BEFORE)
    (note,) = (item.diagnostic for item in findings_in(text) if item.diagnostic.code == "TLT0472")
    assert note.severity == "note"
    assert f"`{offered}`" in (note.help or "")


def test_only_the_step_before_the_first_is_not_asked_for() -> None:
    """`previously true` is false at the first step, and true at all others."""
    clause = "keep a and previously true implies b"
    accepted = accepted_traces(block(clause, before="signal a: bool signal b: bool\n"), "ab", 2)
    assert ("a",) in accepted
    assert ("a", "a") not in accepted
    assert ("a", "ab") in accepted


@pytest.mark.parametrize(
    "clause",
    [
        "keep a implies x >= previous(x)",
        "keep times(a) >= 2 implies x > previous(x)",
        "keep time_holding(a) >= 2 s implies x > previous(x)",
        "keep ends a implies x > previous(x)",
        "keep a and previously a implies x > previous(x)",
        "keep x > previous(x) implies a",
        "keep a implies x > previous(y)",
        "keep a implies x >= previous(x) - 1",
        "keep a implies n < previous(n) + 2",
        "keep a implies previously b",
        "keep a implies previously mode is walk",
        "keep a implies weak_next x > previous(x)",
    ],
)
def test_other_rules_get_none(clause: str) -> None:
    assert "TLT0472" not in codes(block(clause, before=BEFORE))
