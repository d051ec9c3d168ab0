"""TLT0458: `keep x > previous(x)`, which no first step keeps, and `reach times(a) <= 3`, which each one meets."""

from __future__ import annotations

import pytest

from tests.tools.lint.helpers import RANGES, accepted_traces, block, codes, findings_in, labelled_texts_in_block
from tltlc.diagnostics.diagnostic import Diagnostic

BEFORE = f"clock 1 Hz\n{RANGES}signal n: int in [0, 9]\n"
BOOLS = "clock 1 Hz\nsignal a: bool signal b: bool\n"


def warnings(text: str) -> list[Diagnostic]:
    return [finding.diagnostic for finding in findings_in(text) if finding.diagnostic.code == "TLT0458"]


@pytest.mark.parametrize(
    ("clause", "offered"),
    [
        ("keep n > previous(n)", "require weak_next always (n > previous(n))"),
        ("keep x - previous(x) > 2", "require weak_next always (x - previous(x) > 2)"),
        ("require always n > previous(n)", "require weak_next always (n > previous(n))"),
        ("avoid n == previous(n)", "require weak_next always (not (n == previous(n)))"),
        ("avoid not previously a", "require weak_next always (previously a)"),
        ("keep previously a", "require weak_next always (previously a)"),
        ("keep x > initial(x)", "require weak_next always (x > initial(x))"),
        ("keep times(a) >= 3", "reach times(a) >= 3"),
        ("keep times_since(a, b) >= 2", "reach times_since(a, b) >= 2"),
        ("keep total_time(a) >= 3 s", "reach total_time(a) >= 3 s"),
        ("keep time_holding(a) >= 3 s", "keep begins a implies always for 3 s a"),
        ("keep time_holding(a and b) > 3 s", "keep begins (a and b) implies always for 3 s (a and b)"),
        ("keep total_time_within(a, 10 s) >= 2 s", "keep total_time_within(not a, 10 s) <= 8 s"),
        ("keep total_time_within(a or b, 9 s) > 2.5 s", "keep total_time_within(not (a or b), 9 s) < 6.5 s"),
        ("keep total_time_within(a, 1 min) >= 2 s", "reach total_time_within(a, 1 min) >= 2 s"),
        ("reach times(a) <= 3", "keep times(a) <= 3"),
        ("reach total_time(a) < 3 s", "keep total_time(a) < 3 s"),
        ("reach n == previous(n)", "require next eventually (n == previous(n))"),
    ],
)
def test_what_the_first_step_decides_gets_another_clause(clause: str, offered: str) -> None:
    (warning,) = warnings(block(clause, before=BEFORE))
    assert warning.severity == "warning"
    assert (warning.help or "").split("`")[1] == offered
    assert "TLT0458" not in codes(block(offered, before=BEFORE))


@pytest.mark.parametrize("clause", ["keep previously a", "keep times(a) >= 2", "avoid not previously a", "keep ends a"])
def test_no_recording_keeps_a_reported_rule(clause: str) -> None:
    text = block(clause, before=BOOLS)
    assert len(warnings(text)) == 1
    assert accepted_traces(text, "ab", 4) == frozenset()


def test_each_recording_meets_a_reported_goal() -> None:
    text = block("reach times(a) <= 1", before=BOOLS)
    assert len(warnings(text)) == 1
    assert len(accepted_traces(text, "ab", 4)) == 4 + 4**2 + 4**3 + 4**4


def test_the_rule_for_later_steps_has_traces() -> None:
    accepted = accepted_traces(block("require weak_next always (previously a)", before=BOOLS), "ab", 3)
    assert {("",), ("a", ""), ("a", "a", "b")} <= accepted
    assert ("a", "", "") not in accepted


def test_a_part_of_a_rule_and_the_first_of_several_goals_get_a_finding() -> None:
    clauses = ("keep a and n > previous(n)", "reach times(b) <= 3 then c", "reach b")
    assert labelled_texts_in_block("TLT0458", *clauses, before=BEFORE) == ["n > previous(n)", "times(b) <= 3"]
    (formula,) = warnings(f"{BOOLS}spec s = always (times(a) >= 2)")
    assert formula.help == "if it must come, write `eventually (times(a) >= 2)`"
    (forbidden,) = warnings(block("avoid times(a) < 3", before=BOOLS))
    assert forbidden.labels[0].message == "each recording breaks this: at its first step, it is true"


@pytest.mark.parametrize(
    "clause",
    [
        "keep n >= previous(n)",
        "keep a implies n > previous(n)",
        "keep n > previous(n) or a",
        "keep times(a) <= 3",
        "keep times(a) >= 1",
        "keep time_holding(a) <= 3 s",
        "keep time_since(a) <= 3 s",
        "keep once a",
        "keep begins a",
        "avoid previously a",
        "avoid a and previously a",
        "reach times(a) >= 3",
        "reach b and times(a) <= 3",
        "reach time_since(a) <= 3 s",
        "reach x > initial(x)",
        "reach highest(x) <= 5",
        "require eventually n > previous(n)",
        "require n > previous(n)",
        "keep times(a) >= 3  // tltlc: allow TLT0458",
    ],
)
def test_other_clauses_get_no_finding(clause: str) -> None:
    assert warnings(block(clause, before=BEFORE)) == []


def test_a_clock_that_varies_has_the_same_first_step() -> None:
    before = "clock varies\nsignal a: bool\n"
    assert len(warnings(block("keep total_time(a) >= 3 s", before=before))) == 1
    assert warnings(block("keep total_time(a) <= 3 s", before=before)) == []
    assert warnings(block("keep a implies time_since(a) < 3 s", before=before)) == []
