"""TLT0449: a `next` that also asks for another step."""

from __future__ import annotations

import re

import pytest

from tests.tools.lint.helpers import SIGNALS, accepted_traces, block, codes, findings_in, labelled_texts_in_block
from tltlc.diagnostics.diagnostic import Diagnostic

BEFORE = f"clock 10 Hz\n{SIGNALS}"


def notes(text: str) -> list[Diagnostic]:
    return [finding.diagnostic for finding in findings_in(text) if finding.diagnostic.code == "TLT0449"]


def meant(text: str) -> str:
    """Return the clause that the help of the only note names for play that may end."""
    (note,) = notes(text)
    quoted: list[str] = re.findall("`([^`]*)`", note.help or "")
    return quoted[0]


@pytest.mark.parametrize(
    ("clause", "offered"),
    [
        ("keep a implies next b", "keep a implies weak_next b"),
        ("keep a implies (next (b or c))", "keep a implies (weak_next (b or c))"),
        ("keep a -> X b", "keep a -> N b"),
        ("keep a -> ○ b", "keep a -> weak_next b"),
        ("keep a implies next not b", "keep a implies weak_next not b"),
        ("keep a implies next always b", "keep a implies weak_next always b"),
        ("keep a implies next always for 0.2 s not b", "keep a implies weak_next always for 0.2 s not b"),
        ("keep a implies next (b weak_until c)", "keep a implies weak_next (b weak_until c)"),
        ("keep a implies next (b or eventually c)", "keep a implies weak_next (b or eventually c)"),
        ("keep a implies b and next c", "keep a implies b and weak_next c"),
        ("keep a implies next b and next c", "keep a implies weak_next b and weak_next c"),
        ("keep a implies b implies next c", "keep a implies b implies weak_next c"),
        ("require always (a implies next b)", "require always (a implies weak_next b)"),
    ],
)
def test_the_offered_clause_accepts_play_that_ends_there(clause: str, offered: str) -> None:
    assert meant(block(clause, before=BEFORE)) == offered
    assert "TLT0449" not in codes(block(offered, before=BEFORE))
    strong, weak = (accepted_traces(block(text, before=BEFORE), "abc", 2) for text in (clause, offered))
    assert strong < weak and all("a" in trace[-1] for trace in weak - strong)


def test_the_note_names_the_word_and_the_condition() -> None:
    (note,) = notes(block("keep (a and b) implies next c"))
    assert (note.severity, note.title) == ("note", "this `next` also asks for a step after `a and b`")
    assert note.labels[0].message == "so play must not end at the step of `a and b`"
    assert note.help == (
        "if play may end there, write `keep (a and b) implies weak_next c`; "
        "if it must go on, allow it with the comment `// tltlc: allow TLT0449`"
    )


def test_each_condition_gets_a_note_of_its_own() -> None:
    assert [note.title[-3:] for note in notes(block("keep (a implies next c) and (b implies next c)"))] == [
        "`a`",
        "`b`",
    ]


@pytest.mark.parametrize(
    "clauses",
    [
        ("keep a implies next b", "require eventually always not a"),
        ("keep a implies next b", "keep a implies next eventually c"),
        ("keep a implies next b", "keep a implies next c  // tltlc: allow TLT0449"),
        ("keep a implies next b", "avoid a"),
        ("keep a and next b implies next c",),
    ],
)
def test_where_play_cannot_end_there_is_no_note(clauses: tuple[str, ...]) -> None:
    assert labelled_texts_in_block("TLT0449", *clauses, before=BEFORE) == []


@pytest.mark.parametrize(
    "clause",
    [
        "keep a implies weak_next b",
        "keep a implies next eventually b",
        "keep a implies next (eventually within 0.3 s b)",
        "keep a implies next (b and eventually c)",
        "keep a implies next (b until c)",
        "keep a implies next (b then c)",
        "keep a implies next after 2 steps b",
        "keep a implies weak_next next b",
        "keep a implies not next b",
        "keep a implies b or next c",
        "keep next a implies b",
        "require a implies next b",
        "avoid a and next b",
        "reach a and next b",
        "keep a implies next b  // tltlc: allow TLT0449",
    ],
)
def test_other_clauses_get_no_note(clause: str) -> None:
    assert labelled_texts_in_block("TLT0449", clause, before=BEFORE) == []


@pytest.mark.parametrize(
    ("clause", "code", "clock"),
    [
        ("keep a implies next next b", "TLT0418", "clock 10 Hz"),
        ("keep a implies next always for 2 s not b", "TLT0439", "clock varies"),
        ("keep a implies next(gold) > gold", "TLT0416", "clock 10 Hz"),
    ],
)
def test_another_diagnostic_of_the_same_operator_comes_first(clause: str, code: str, clock: str) -> None:
    reported = codes(block(clause, before=f"{clock}\n{SIGNALS}signal gold in [0, 9]\n"))
    assert [reported.count(code), "TLT0449" in reported] == [1, False]


def test_on_a_clock_that_varies_no_goal_in_time_gets_a_note() -> None:
    before = f"clock varies\n{SIGNALS}"
    clause = "keep a implies next eventually within 2 s b"
    assert labelled_texts_in_block("TLT0449", clause, before=before) == []
    assert labelled_texts_in_block("TLT0449", "keep a implies next b", before=before) == ["next b"]


def test_play_without_an_end_gets_no_note() -> None:
    assert labelled_texts_in_block("TLT0449", "semantics infinite", "keep a implies next b") == []
