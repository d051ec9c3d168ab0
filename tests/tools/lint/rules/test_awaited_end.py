"""TLT0448: an `until` that also asks that its end comes."""

from __future__ import annotations

import re

import pytest

from tests.tools.lint.helpers import SIGNALS, accepted_traces, block, codes, findings_in, labelled_texts_in_block
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.tools.lint.asked_results import _MOST_PARTS

BEFORE = f"{SIGNALS}signal d: bool\n"


def notes(text: str) -> list[Diagnostic]:
    return [finding.diagnostic for finding in findings_in(text) if finding.diagnostic.code == "TLT0448"]


def meant(text: str) -> str:
    """Return the clause that the help of the only note names for an end that need not come."""
    (note,) = notes(text)
    quoted: list[str] = re.findall("`([^`]*)`", note.help or "")
    return quoted[1]


@pytest.mark.parametrize(
    ("clause", "offered"),
    [
        (
            "keep begins a implies eventually within 2 steps (b and (b until c))",
            "keep begins a implies eventually within 2 steps (b and (b weak_until c))",
        ),
        ("keep a implies not b until c", "keep a implies not b weak_until c"),
        ("keep a implies (not b until c)", "keep a implies (not b weak_until c)"),
        ("keep a implies b U c", "keep a implies b W c"),
        ("keep a -> b 𝒰 c", "keep a -> b weak_until c"),
        (
            "keep a implies (d and (not b until (c or a and b)))",
            "keep a implies (d and (not b weak_until (c or a and b)))",
        ),
        ("keep (b implies d) and (a implies b until c)", "keep (b implies d) and (a implies b weak_until c)"),
        ("keep a implies d implies b until c", "keep a implies d implies b weak_until c"),
        ("keep a implies weak_next (b until c)", "keep a implies weak_next (b weak_until c)"),
        ("keep a implies next (b U c)", "keep a implies weak_next (b W c)"),
        ("require always (a implies b until c)", "require always (a implies b weak_until c)"),
        (
            "keep a implies (b until c) and (d until c)",
            "keep a implies (b weak_until c) and (d weak_until c)",
        ),
    ],
)
def test_the_offered_clause_accepts_play_that_ends_before(clause: str, offered: str) -> None:
    assert meant(block(clause, before=BEFORE)) == offered
    assert "TLT0448" not in codes(block(offered, before=BEFORE))
    strong, weak = (accepted_traces(block(text, before=BEFORE), "abcd", 2) for text in (clause, offered))
    assert strong < weak


def test_the_note_names_the_word_and_the_end() -> None:
    (note,) = notes(block("keep a implies not b until c"))
    assert (note.severity, note.title) == ("note", "this `until` also asks that `c` comes")
    assert note.labels[0].message == "so play must not end before `c` comes"
    assert note.help == (
        "if `c` need not come, write `keep a implies not b weak_until c`; "
        "if it must come, allow it with the comment `// tltlc: allow TLT0448`"
    )


def test_each_end_gets_a_note_of_its_own() -> None:
    both = block("keep a implies (not b until c) and (not c until d)", before=BEFORE)
    assert [note.title[-9:] for note in notes(both)] == ["`c` comes", "`d` comes"]


def test_the_offered_clause_has_no_comment() -> None:
    clause = "keep a implies  // first\n    b until  // then\n    c"
    assert meant(block(clause)) == "keep a implies b weak_until c"


def test_an_entity_of_a_quantifier_keeps_its_variable() -> None:
    before = f"{SIGNALS}entity x, y\nsignal near(e): bool\n"
    clause = "keep all e in (x, y): near(e) implies not a until b"
    assert meant(block(clause, before=before)) == clause.replace("until", "weak_until")


def test_in_a_formula_only_the_formula_is_offered() -> None:
    assert meant(f"{SIGNALS}spec s = always (a implies b until c)") == "always (a implies b weak_until c)"


@pytest.mark.parametrize(
    "clauses",
    [
        ("keep a implies (not b until c) and eventually c",),
        ("keep a implies (not b until c)", "keep a implies eventually c"),
        ("keep a implies (not b until c)", "keep a implies eventually (c and d)"),
        ("keep a implies (not b until c)", "keep within 50 s of a, c"),
        ("keep a implies ((not b until c) or always not b)",),
        ("keep a implies not b until c", "avoid a"),
        ("keep a implies not b until c", "require eventually always c"),
    ],
)
def test_an_end_that_is_asked_for_elsewhere_gets_no_note(clauses: tuple[str, ...]) -> None:
    assert labelled_texts_in_block("TLT0448", *clauses, before=f"clock 10 Hz\n{BEFORE}") == []


def test_a_time_without_the_end_does_not_ask_for_it() -> None:
    for other in ("require always for 8 s not a", "keep always for 1 s not a or eventually within 5 s d"):
        clauses = ("keep a implies not b until c", other)
        assert labelled_texts_in_block("TLT0448", *clauses, before=f"clock 10 Hz\n{BEFORE}") == ["not b until c"]


def test_a_goal_that_may_come_before_is_no_end() -> None:
    assert labelled_texts_in_block("TLT0448", "keep a implies (not b until c)", "reach c") == ["not b until c"]


def test_many_clauses_are_not_compared() -> None:
    clauses = [f"avoid b and {'next ' * count}d" for count in range(_MOST_PARTS)]
    rule = ("keep a implies not b until c", "keep a implies eventually c")
    assert labelled_texts_in_block("TLT0448", *rule, *clauses, before=BEFORE) == ["not b until c"]


@pytest.mark.parametrize(
    "clause",
    [
        "keep a implies not b weak_until c",
        "keep a implies (b release c)",
        "keep a implies (b strong_release c)",
        "keep a implies always (b until c)",
        "keep a implies not (b until c)",
        "keep (a until b) implies c",
        "keep a until b",
        "require a implies (b until c)",
        "require a until b",
        "avoid a and (b until c)",
        "reach a until b",
        "keep any x in (p, q): near(x) implies b until c",
        "keep a implies not b until c  // tltlc: allow TLT0448",
    ],
)
def test_other_clauses_get_no_note(clause: str) -> None:
    before = f"{BEFORE}entity p, q\nsignal near(e): bool\n"
    assert labelled_texts_in_block("TLT0448", clause, before=before) == []


@pytest.mark.parametrize(
    ("clause", "code"),
    [
        ("keep a implies not a until c", "TLT0440"),
        ("keep x > 5 implies x < 3 until c", "TLT0440"),
        ("keep a implies eventually b until c", "TLT0446"),
    ],
)
def test_a_warning_about_the_same_operator_comes_first(clause: str, code: str) -> None:
    reported = codes(block(clause, before=f"{BEFORE}signal x in [0, 10]\n"))
    assert [reported.count(code), "TLT0448" in reported] == [1, False]


def test_play_without_an_end_gets_no_note() -> None:
    assert labelled_texts_in_block("TLT0448", "semantics infinite", "keep a implies not b until c") == []


def test_a_clock_that_varies_gets_the_note_where_times_are_unknown() -> None:
    before = f"clock varies\n{SIGNALS}"
    assert labelled_texts_in_block("TLT0448", "keep a implies not b until c", before=before) == ["not b until c"]
