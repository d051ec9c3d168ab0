"""TLT0462: `a or b and c`, which is read as `a or (b and c)`."""

from __future__ import annotations

import re

import pytest

from tests.tools.lint.helpers import SIGNALS, accepted_traces, block, codes, findings_in, labelled_texts_in_block

BEFORE = f"{SIGNALS}signal d: bool\n"


@pytest.mark.parametrize(
    ("mixed", "read", "other"),
    [
        ("a or b and c", "a or (b and c)", "(a or b) and c"),
        ("a and b or c", "(a and b) or c", "a and (b or c)"),
        ("a and b and d or not c", "(a and b and d) or not c", "a and b and (d or not c)"),
        ("a or b and c and d", "a or (b and c and d)", "(a or b) and c and d"),
    ],
)
def test_both_readings_are_offered(mixed: str, read: str, other: str) -> None:
    text = block(f"keep {mixed}", before=BEFORE)
    (note,) = (item.diagnostic for item in findings_in(text) if item.diagnostic.code == "TLT0462")
    assert note.severity == "note"
    assert re.findall("`([^`]*)`", note.help or "") == [read, other]
    accepted = [accepted_traces(block(f"keep {form}", before=BEFORE), "abcd", 1) for form in (mixed, read, other)]
    assert accepted[0] == accepted[1] != accepted[2]
    assert "TLT0462" not in [code for form in (read, other) for code in codes(block(f"keep {form}", before=BEFORE))]


def test_a_longer_chain_gets_the_brackets_of_its_own_reading() -> None:
    (note,) = findings_in(f"{BEFORE}spec s = G(a or b and c or d)")
    assert note.diagnostic.help == "write `a or (b and c) or d` if you mean this"


@pytest.mark.parametrize(
    "clause",
    [
        "keep a or (b and c)",
        "keep (a or b) and c",
        "keep a and b or c and d",
        "keep a | b & c",
        "keep a or b implies c and d",
        "keep a\n    or b and c",
        "keep a or b and c  // tltlc: allow TLT0462",
    ],
)
def test_other_clauses_get_no_note(clause: str) -> None:
    assert labelled_texts_in_block("TLT0462", clause, before=BEFORE) == []
