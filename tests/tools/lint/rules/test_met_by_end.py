"""TLT0456: `eventually (a until b)`, which a step with b alone meets."""

from __future__ import annotations

import re

import pytest

from tests.tools.lint.helpers import RANGES, accepted_traces, block, codes, findings_in, labelled_texts_in_block
from tltlc.diagnostics.diagnostic import Diagnostic

BEFORE = "clock 1 Hz\nsignal a: bool signal b: bool signal c: bool\n"


def notes(text: str) -> list[Diagnostic]:
    return [finding.diagnostic for finding in findings_in(text) if finding.diagnostic.code == "TLT0456"]


def offered(text: str) -> list[str]:
    """Return what the help of the only note says to write."""
    (note,) = notes(text)
    return re.findall("write `([^`]*)`", note.help or "")


@pytest.mark.parametrize(
    ("clause", "old", "meant"),
    [
        ("keep c implies eventually (a until b)", "eventually (a until b)", "eventually (a and (a until b))"),
        (
            "keep c implies eventually within 1 s (a weak_until b)",
            "eventually within 1 s (a weak_until b)",
            "eventually within 1 s (a and (a weak_until b))",
        ),
        ("keep c implies F[0,1] (a U b)", "F[0,1] (a U b)", "F[0,1] (a and (a U b))"),
        ("reach a weak_until b", "reach a weak_until b", "reach a and (a weak_until b)"),
        ("reach c then (a weak_until b)", "reach c then (a weak_until b)", "reach c then (a and (a weak_until b))"),
    ],
)
def test_the_offered_clause_asks_for_the_first_half(clause: str, old: str, meant: str) -> None:
    assert offered(block(clause, before=BEFORE))[0] == meant
    edited = clause.replace(old, meant)
    assert "TLT0456" not in codes(block(edited, before=BEFORE))
    before, after = (accepted_traces(block(text, before=BEFORE), "abc", 3) for text in (clause, edited))
    assert after < before
    # Without a, b alone never meets what is offered.
    assert ("bc",) not in after
    assert ("c", "b") not in after


@pytest.mark.parametrize("clause", ["require eventually (a until b)", "keep c implies F (a U b)"])
def test_without_a_time_the_end_alone_says_the_same(clause: str) -> None:
    text = block(clause, before=BEFORE)
    _, alone = offered(text)
    same = re.sub(r"(eventually|F) .*", alone, clause)
    assert accepted_traces(text, "abc", 3) == accepted_traces(block(same, before=BEFORE), "abc", 3)


def test_with_a_time_nothing_shorter_says_the_same() -> None:
    text = block("require eventually within 1 s (a until b)", before=BEFORE)
    assert len(offered(text)) == 1
    shorter = block("require eventually within 1 s b", before=BEFORE)
    assert accepted_traces(shorter, "abc", 3) < accepted_traces(text, "abc", 3)


def test_the_note_names_the_end_and_the_operator() -> None:
    (note,) = notes(block("keep c implies eventually within 2 s (a weak_until b)", before=BEFORE))
    assert (note.severity, note.title) == ("note", "`b` alone meets this `weak_until`")
    assert note.labels[0].message == "`eventually within 2 s` may wait for a step with `b`, with or without `a`"
    assert note.help == (
        "if `a` must come first, write `eventually within 2 s (a and (a weak_until b))`; "
        "if `b` alone is enough, allow it with the comment `// tltlc: allow TLT0456`"
    )


@pytest.mark.parametrize(
    "clause",
    [
        "keep time_holding(x > 8) >= 3 s implies eventually within 3 s (a weak_until x < 3)",
        "keep begins c implies b and eventually (a until (b or c))",
        "avoid c and eventually (a until b)",
        "keep all e in (p, q): near(e) implies eventually (a until b)",
    ],
)
def test_nested_operators_get_a_note(clause: str) -> None:
    before = f"clock 1 Hz\n{RANGES}entity p, q\nsignal near(e): bool\n"
    assert len(notes(block(clause, before=before))) == 1


@pytest.mark.parametrize(
    "clause",
    [
        # The end is that of the condition.
        "keep begins c implies eventually within 5 s (a weak_until not c)",
        "keep c and b implies eventually (a until not c)",
        "keep time_holding(c) >= 3 s implies eventually within 5 s (a weak_until not c)",
        # The first half holds at each step with the end.
        "keep c implies eventually (a until (a and b))",
        "keep c implies eventually (x > 3 until x > 5)",
        # Another finding says more.
        "keep c implies always eventually (a until b)",
        "reach a until b",
        "reach c then (a until b)",
        # Here, the first half does have an effect.
        "keep c implies (a until b)",
        "keep c implies eventually (a and (a until b))",
        "keep c implies next (a until b)",
        "keep c implies eventually always (a until b)",
        "reach (a weak_until b) then c",
        "keep c implies eventually within 2 s (a weak_until b)  // tltlc: allow TLT0456",
    ],
)
def test_other_clauses_get_no_note(clause: str) -> None:
    assert labelled_texts_in_block("TLT0456", clause, before=f"clock 1 Hz\n{RANGES}") == []
