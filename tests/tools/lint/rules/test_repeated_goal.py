"""TLT0445: the same goal twice in a row."""

from __future__ import annotations

import re

import pytest

from tests.tools.lint.helpers import RANGES, accepted_traces, block, codes, findings_in, labelled_texts_in_block


def help_of(clause: str, before: str = RANGES) -> str:
    text = block(clause, before=before)
    (finding,) = (finding for finding in findings_in(text) if finding.diagnostic.code == "TLT0445")
    return finding.diagnostic.help or ""


def quoted(clause: str) -> list[str]:
    return re.findall("`([^`]*)`", help_of(clause, f"clock 1 Hz\n{RANGES}"))


@pytest.mark.parametrize(
    ("clause", "goal"),
    [
        ("reach a then a", "a"),
        ("reach b then a then a", "a"),
        ("reach a then a then a", "a"),
        ("reach (a and b) then (a and b)", "(a and b)"),
        ("reach x > 3 then x >  3", "x >  3"),
        ("reach a then within 5 steps a", "a"),
        ("avoid a then a", "a"),
        ("avoid (a and b) then (a and b)", "(a and b)"),
        ("avoid a then within 5 steps a", "a"),
    ],
)
def test_a_goal_that_is_the_goal_before_it_is_reported(clause: str, goal: str) -> None:
    assert labelled_texts_in_block("TLT0445", clause, before=RANGES) == [goal]


@pytest.mark.parametrize(
    "clause",
    [
        "reach a then b then a",
        "reach a then begins a",
        "reach begins a then begins a",
        "reach a then (a and b)",
        "reach x > 3 then x > 4",
        "reach once a then once a",
        "keep b implies eventually a",
        "avoid a then b then a",
        "avoid (begins a) then (begins a)",
        "avoid (once a) then (once a)",
    ],
)
def test_goals_that_differ_or_are_about_several_steps_are_left_out(clause: str) -> None:
    assert "TLT0445" not in codes(block(clause, before=RANGES))


def test_two_steps_meet_the_clause_and_not_what_the_help_suggests() -> None:
    again, lasting = quoted("reach a then a")
    assert (again, lasting) == ("reach times(a) >= 2", "reach time_holding(a) >= 3 s")
    clauses = ("reach a then a", again, lasting)
    before = "clock 1 Hz signal a: bool\n"
    typed, counted, held = (accepted_traces(block(clause, before=before), "a") for clause in clauses)
    assert ("a", "a") in typed
    assert ("a", "a") not in counted | held
    assert counted < typed and held < typed


def test_all_goals_that_are_the_same_are_counted() -> None:
    assert quoted("reach a then a then a")[0] == "reach times(a) >= 3"


def test_among_other_goals_the_second_one_begins() -> None:
    assert quoted("reach b then a then a") == ["begins a", "time_holding(a) >= 3 s"]


def test_a_time_that_the_goal_holds_needs_a_clock() -> None:
    assert "time_holding" not in help_of("reach a then a")


@pytest.mark.parametrize(
    ("clause", "again"),
    [
        ("avoid a then a", "keep times(a) <= 1"),
        ("avoid a then a then a", "keep times(a) <= 2"),
        ("avoid a then within 2 s a", "avoid (begins a) then within 2 s (begins a)"),
        ("avoid a then within 2 steps a", "avoid (begins a) then within 2 steps (begins a)"),
        ("avoid not a then not a", "keep times(not a) <= 1"),
    ],
)
def test_what_must_not_begin_again_may_last(clause: str, again: str) -> None:
    assert quoted(clause) == [again, "// tltlc: allow TLT0445"]
    before = "clock 1 Hz signal a: bool\n"
    assert "TLT0445" not in codes(block(again, before=before))
    typed, begun = (accepted_traces(block(text, before=before), "a") for text in (clause, again))
    assert typed < begun
    event, other = ("", "a") if "not" in clause else ("a", "")
    assert (event, event, event) in begun - typed
    assert (event, other) * clause.count("then") + (event,) not in begun


def test_between_other_events_the_second_one_begins() -> None:
    assert quoted("avoid b then a then a") == ["(begins a)", "// tltlc: allow TLT0445"]
    assert "TLT0445" not in codes(block("avoid b then a then (begins a)"))
