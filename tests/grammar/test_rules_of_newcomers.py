"""Rules of newcomers about two events and the time between them, with the clauses that they get."""

from __future__ import annotations

import pytest

import tltlc
from tests.grammar.phrases_as_typed import errors
from tests.grammar.sentences import HEAD
from tltlc.core.source import SourceFile
from tltlc.grammar.english.forms import PAST

ONE = {
    "whenever phase stops being menu, fire was used in the last 3 s": [
        "keep ends (phase is menu) implies once within 3 s fire"
    ],
    "keep begins fire implies spray happened in the last 3 s": ["keep begins fire implies once within 3 s spray"],
    "fire only if spray was pressed in the last 2 s": ["keep fire implies once within 2 s spray"],
    # Two events.
    "never fire twice without spray in between": ["keep times_since(fire, spray) <= 1"],
    "no two fire without spray in between": ["keep times_since(fire, spray) <= 1"],
    "fire never 3 times without spray between them": ["keep times_since(fire, spray) <= 2"],
    "at least 2 s between two begins fire": ["avoid (begins fire) then within 2 s (begins fire)"],
    "at least 2 s between two starts of fire": ["avoid (begins fire) then within 2 s (begins fire)"],
    "keep ends fire implies between 6 s and 12 s since begins fire": [
        "keep ends fire implies time_since(begins fire) >= 6 s and time_since(begins fire) <= 12 s"
    ],
    "when fire ends, at least 6 s since fire began": ["keep ends fire implies time_since(begins fire) >= 6 s"],
}
NONE = [
    "keep begins fire implies at least 3 s since begins fire",  # which is 0 s at each beginning
    "when spray then at least 3 s since fire",  # its first step, or its last one
]


def help_of(typed: str) -> list[str]:
    (error,) = errors(SourceFile("a.tltl", f"{HEAD}spec s {{\n{typed}\n}}\n"))
    return (error.help or "").splitlines()


@pytest.mark.parametrize("typed", ONE)
def test_a_sentence_with_one_meaning_gets_its_clauses(typed: str) -> None:
    clauses = ONE[typed]
    assert help_of(typed)[0] == "write " + " and ".join(f"`{clause}`" for clause in clauses)
    tltlc.compile_text(f"{HEAD}spec s {{\n{chr(10).join(clauses)}\n}}\n")


@pytest.mark.parametrize("typed", NONE)
def test_a_time_since_an_event_gets_no_clause_that_may_miss_its_meaning(typed: str) -> None:
    assert "time_since(" not in "".join(help_of(typed))


@pytest.mark.parametrize("clause", sorted({pattern.clause for patterns in PAST.values() for pattern in patterns}))
def test_a_form_that_looks_back_compiles(clause: str) -> None:
    text = clause.format(t="fire", r="spray", p="spray", T="2 s")
    assert tltlc.compile_text(f"{HEAD}spec s {{ {text} }}")


@pytest.mark.parametrize(
    ("sentence", "forms"),
    [
        (
            "whenever fire ends, spray was on used in the last 3 s",
            [
                "`keep ends fire implies once within 3 s spray`: "
                "at each step with `ends fire`, `spray` then or at most 3 s before"
            ],
        ),
        (
            "spray comes used when fire used was in the last 3 s",
            [
                "`keep spray implies once within 3 s fire`: `spray` only at most 3 s after `fire`, or at the same step",
                "`keep once within 3 s fire implies spray`: at each step at most 3 s after `fire`, `spray`",
            ],
        ),
    ],
)
def test_the_forms_of_a_time_in_the_past_look_back(sentence: str, forms: list[str]) -> None:
    assert help_of(sentence) == ["write one of these, if it says what you mean:", *forms]
