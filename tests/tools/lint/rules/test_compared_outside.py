"""TLT0474: rules about the steps with a value of an enum that compare with the step before the first of them."""

from __future__ import annotations

import pytest

from tests.tools.lint.helpers import RANGES, block, codes, findings_in

BEFORE = f"clock 1 Hz\n{RANGES}signal n: int in [0, 9]\nsignal mode: (walk, run)\n"


@pytest.mark.parametrize(
    ("clause", "offered"),
    [
        (
            "keep mode is run implies n <= previous(n)",
            "keep mode is run and previously mode is run implies n <= previous(n)",
        ),
        (
            "keep a and mode is not run implies previous(x) + 0.25 >= x",
            "keep a and mode is not run and previously mode is not run implies previous(x) + 0.25 >= x",
        ),
        ("keep mode is run implies (a and n == previous(n))", "and previously mode is run"),
        ("keep a implies n <= previous(n)", "keep a and previously a implies n <= previous(n)"),
        (
            "keep not a implies n <= previous(n) or b",
            "keep not a and previously not a implies n <= previous(n) or b",
        ),
    ],
)
def test_a_rule_about_a_state_gets_a_note(clause: str, offered: str) -> None:
    (note,) = (
        item.diagnostic for item in findings_in(block(clause, before=BEFORE)) if item.diagnostic.code == "TLT0474"
    )
    assert note.severity == "note"
    assert f"`{offered}`" in (note.help or "")


@pytest.mark.parametrize(
    "clause",
    [
        "keep mode is run and previously mode is run implies n <= previous(n)",
        "keep begins mode is run implies n <= 3",
        "keep mode is run implies n <= previous(n, 2 s)",
        "keep mode is run implies n > previous(n)",
        "keep n <= previous(n)",
        "keep a implies n == previous(n) - 1 or b",
        "keep mode is run implies n <= previous(n) - 1",
        "keep mode is run implies previous(n) + 1 <= n",
    ],
)
def test_other_rules_get_none(clause: str) -> None:
    assert "TLT0474" not in codes(block(clause, before=BEFORE))
