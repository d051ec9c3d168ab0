"""A sentence that no rule of the grammar reads gets forms of clauses with its conditions."""

from __future__ import annotations

import pytest

from tltlc import compile_text
from tltlc.core.source import SourceFile
from tltlc.grammar.english.forms import PATTERNS
from tltlc.grammar.parser import parse

DECLARATIONS = "clock 10 Hz\nsignal a: bool\nsignal b: bool\nsignal c: bool\nsignal mode: (idle, chase)\n"
PLACES = {"a": "a", "b": "b", "c": "c", "t": "a", "r": "b", "p": "b", "T": "2 s", "n": "3"}


def help_of(clause: str) -> list[str]:
    _, errors = parse(SourceFile("a.tltl", f"{DECLARATIONS}spec s {{ {clause} }}"))
    return (errors[0].help or "").splitlines()


@pytest.mark.parametrize(
    "clause",
    sorted({pattern.clause.format(**PLACES) for patterns in PATTERNS.values() for pattern in patterns}),
)
def test_a_form_compiles(clause: str) -> None:
    assert compile_text(f"{DECLARATIONS}spec s {{ {clause} }}")


@pytest.mark.parametrize(
    ("sentence", "form"),
    [
        ("once a happens a has to stay", "`keep a implies always a`: from the first `a` on, `a` at every step"),
        ("we must have had a for 3 s at some point", "`reach time_holding(a) >= 3 s`: `a` for 3 s in a row, once"),
        ("a never ever again for more than 2 s", "`avoid time_holding(a) > 2 s`: `a` never for more than 2 s in a row"),
        (
            "a or so only until b is the case",
            "`require a until b`: `a` at every step before `b`, which must come",
        ),
        (
            "mode == chase so we do until b",
            "`require mode is chase weak_until b`: `mode is chase` at every step before `b`, which need not come",
        ),
    ],
)
def test_a_sentence_without_a_reading_gets_forms(sentence: str, form: str) -> None:
    first, *lines = help_of(sentence)
    assert first == "write one of these, if it says what you mean:"
    assert form in lines
    assert len(lines) <= 4


def test_a_form_keeps_the_words_about_beginnings_and_times() -> None:
    forms = help_of("so begins a then b within 2 s or so")[1:]
    assert forms == [
        "`keep begins a implies eventually within 2 s b`: at every step with `begins a`, `b` then or at most 2 s later",
        "`reach begins a then within 2 s b`: `begins a` at some step, and `b` at most 2 s later",
    ]


def test_a_form_joins_begins_and_the_condition_behind_it() -> None:
    forms = help_of("so begins (a and c) then b within 2 s or so")[1:]
    assert forms
    assert all("begins (a and c)" in form for form in forms)


@pytest.mark.parametrize(
    "sentence",
    [
        "a whatsoever until the dragon b",  # a word that may say something
        "at some point mode idle for 10 to 40 s of b",  # a number that is in no condition
        "a gadget between b and c then",  # `and` joins no conditions here
        "count(a) blah b",  # a call of something that is not declared
    ],
)
def test_a_form_leaves_nothing_out(sentence: str) -> None:
    assert help_of(sentence)[0] != "write one of these, if it says what you mean:"
