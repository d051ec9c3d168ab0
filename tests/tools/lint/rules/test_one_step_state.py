"""TLT0460: `keep p implies previously q` where p and q never hold together."""

from __future__ import annotations

import pytest

from tests.tools.lint.helpers import RANGES, block, codes, findings_in, labelled_texts_in_block
from tltlc.monitor.monitor import Monitor
from tltlc.pipeline import compile_text

BEFORE = f"clock 1 Hz\n{RANGES}signal mode: (idle, alert, chase)\nexclusive a, b\n"


@pytest.mark.parametrize(
    ("clause", "offered"),
    [
        (
            "keep mode is chase implies previously mode is alert",
            "begins mode is chase implies previously mode is alert",
        ),
        ("keep mode is chase implies weak_next mode is alert", "ends mode is chase implies mode is alert"),
        ("keep mode is chase implies next (mode is alert)", "ends mode is chase implies mode is alert"),
        ("keep x > 8 and c implies previously x < 2", "begins (x > 8 and c) implies previously x < 2"),
        ("keep a implies previously b", "begins a implies previously b"),
        ("require always (a implies previously b)", "begins a implies previously b"),
    ],
)
def test_the_rule_for_the_change_is_offered(clause: str, offered: str) -> None:
    text = block(clause, before=BEFORE)
    (note,) = (item.diagnostic for item in findings_in(text) if item.diagnostic.code == "TLT0460")
    assert note.severity == "note"
    assert (note.help or "").split("`")[1] == offered
    assert "TLT0460" not in codes(block(f"keep {offered}", before=BEFORE))


@pytest.mark.parametrize(
    ("values", "accepted_by_each", "accepted_by_first"),
    [([1, 9], True, True), ([1, 9, 9], False, True), ([1, 9, 5, 9], False, False), ([9], False, False)],
)
def test_only_the_offered_rule_lets_the_condition_last(
    values: list[float], accepted_by_each: bool, accepted_by_first: bool
) -> None:
    for clause, accepted in (
        ("keep x > 8 implies previously x < 2", accepted_by_each),
        ("keep begins x > 8 implies previously x < 2", accepted_by_first),
    ):
        (fspa,) = compile_text(block(clause, before="signal x in [0, 10]\n"))
        monitor = Monitor(fspa)
        assert [monitor.step({"x": value}).accepting for value in values][-1] == accepted


@pytest.mark.parametrize(
    "clause",
    [
        "keep a implies previously c",
        "keep begins mode is chase implies previously mode is alert",
        "keep mode is chase implies previously (mode is alert or mode is chase)",
        # This says that a never holds at two steps in a row.
        "keep a implies previously not a",
        "keep a implies weak_next not a",
        "keep a implies previously (c and not a)",
        "keep a and c implies weak_next not c",
        "keep mode is chase implies once mode is alert",
        "keep mode is chase implies next after 3 steps mode is alert",
        "keep a implies previously b  // tltlc: allow TLT0460",
    ],
)
def test_other_clauses_get_no_note(clause: str) -> None:
    assert labelled_texts_in_block("TLT0460", clause, before=BEFORE) == []
