"""TLT0476: values at the end of a condition, which are from the first step without it."""

from __future__ import annotations

import pytest

from tests.tools.lint.helpers import RANGES, block, codes, findings_in

BEFORE = f"clock 1 Hz\n{RANGES}signal n: int in [0, 9]\n"


@pytest.mark.parametrize(
    ("clause", "offered"),
    [
        ("keep begins a implies n == value_at(n, ends a)", "value_at(previous(n), ends a)"),
        ("keep begins a implies n > value_at(n, previously a)", "previous(value_at(n, a))"),
        ("keep b implies x >= 0.5 * value_at(x, ends (a or b))", "value_at(previous(x), ends (a or b))"),
    ],
)
def test_a_value_at_an_end_gets_a_note(clause: str, offered: str) -> None:
    findings = findings_in(block(clause, before=BEFORE))
    (note,) = (item.diagnostic for item in findings if item.diagnostic.code == "TLT0476")
    assert note.severity == "note"
    assert f"`{offered}`" in (note.help or "")


@pytest.mark.parametrize(
    "clause",
    [
        "keep begins a implies n == value_at(previous(n), ends a)",
        "keep a implies n == value_at(n, begins a)",
        "keep a implies n >= value_at(n, b)",
    ],
)
def test_other_values_get_none(clause: str) -> None:
    assert "TLT0476" not in codes(block(clause, before=BEFORE))
