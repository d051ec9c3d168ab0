"""Sentences of newcomers about what came before, what stays, and the end of play, with the clauses that they get."""

from __future__ import annotations

import pytest

import tltlc
from tests.grammar.phrases_as_typed import errors
from tests.grammar.test_english_sentences import HEAD
from tltlc.core.source import SourceFile

ONE = {
    "once fire begins it stays on for at least 10 s": ["keep begins fire implies always for 10 s fire"],
    "keep fire implies spray is off": ["keep fire implies not spray"],
    "reach fire then spray then boss_dead within 5 min of fire": [
        "reach fire then spray then (boss_dead and once within 5 min begins fire)"
    ],
    "reach fire then spray within 5 s of fire": ["reach fire then within 5 s spray"],
    "fire at most 3 times and only when phase is menu": ["keep times(fire) <= 3", "keep fire implies phase is menu"],
    "reach health > 80 within 5 min then always health >= 60": [
        "require eventually within 5 min health > 80",
        "keep health > 80 implies always health >= 60",
    ],
    "keep health - previous(health) between -2 and 2 unless begins fire or ends fire": [
        "keep (health - previous(health) >= -2 and health - previous(health) <= 2) or (begins fire or ends fire)"
    ],
    "for the last 10 s fire": ["require eventually always time_holding(fire) >= 10 s"],
    "when phase was menu and is not menu anymore then fire": ["keep ends (phase is menu) implies fire"],
    "whenever fire begins, spray within 20 s unless fire ends before that": [
        "keep begins fire implies eventually within 20 s (spray or ends fire)"
    ],
    "keep fire implies spray unless once boss_dead": ["keep fire implies spray or once boss_dead"],
}
SEVERAL = {
    "keep begins fire implies eventually within 4 s (phase is menu or phase is shift) unless once spray": [
        "keep begins fire implies once spray or (eventually within 4 s (phase is menu or phase is shift))",
        "keep begins fire implies eventually within 4 s ((phase is menu or phase is shift) or once spray)",
    ],
    "keep fire implies once before spray": [
        "keep fire implies once spray",
        "keep fire implies previously once spray",
    ],
    "keep fire implies spray happened before": [
        "keep fire implies once spray",
        "keep fire implies previously once spray",
    ],
    "keep begins fire implies eventually within 10 s spray, and after that not boss_dead until fire": [
        "keep begins fire implies eventually within 10 s (spray and (not boss_dead weak_until fire))",
        "keep begins fire implies eventually within 10 s (spray and (not boss_dead until fire))",
    ],
}


def help_of(typed: str) -> str:
    return errors(SourceFile("a.tltl", f"{HEAD}spec s {{\n{typed}\n}}\n"))[0].help or ""


@pytest.mark.parametrize("typed", ONE)
def test_a_sentence_with_one_meaning_gets_its_clauses(typed: str) -> None:
    clauses = ONE[typed]
    assert help_of(typed).splitlines()[0] == "write " + " and ".join(f"`{clause}`" for clause in clauses)
    tltlc.compile_text(f"{HEAD}spec s {{\n{chr(10).join(clauses)}\n}}\n")


@pytest.mark.parametrize("typed", SEVERAL)
def test_a_sentence_with_several_meanings_gets_all_of_them(typed: str) -> None:
    text = help_of(typed)
    for clause in SEVERAL[typed]:
        assert f"`{clause}`" in text
        tltlc.compile_text(f"{HEAD}spec s {{\n{clause}\n}}\n")
