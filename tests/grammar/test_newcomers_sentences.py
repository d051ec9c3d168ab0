"""Sentences of newcomers about what came before, what stays, and the end of play, with the clauses that they get."""

from __future__ import annotations

import pytest

import tltlc
from tests.grammar.phrases_as_typed import errors
from tests.grammar.sentences import HEAD
from tltlc.core.source import SourceFile
from tltlc.monitor import Monitor

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
    "when coins reaches 20 then fire within 2 s": ["keep begins (coins >= 20) implies eventually within 2 s fire"],
    "when times_since(fire, ends spray) reaches 3 then boss_dead for 6 s": [
        "keep begins (times_since(fire, ends spray) >= 3) implies always for 6 s boss_dead"
    ],
    "keep spray implies always in the last 10 s health <= 5": ["keep spray implies time_holding(health <= 5) >= 10 s"],
    "when health falls below 20, fire within 1 s and for at least 4 s": [
        "keep begins (health < 20) implies eventually within 1 s always for 4 s fire"
    ],
    "health may only increase while fire or ends fire": ["keep health > previous(health) implies fire or ends fire"],
    "keep begins fire implies once spray and no boss_dead since spray": [
        "keep begins fire implies (not boss_dead since spray)"
    ],
    "once fire has been true for 1 s, health stays between 3 and 5 until the end": [
        "keep time_holding(fire) >= 1 s implies always (health >= 3 and health <= 5)"
    ],
    "keep fire implies health between 5 and 30, except in the first 0.5 s of fire": [
        "keep time_holding(fire) >= 0.5 s implies health >= 5 and health <= 30"
    ],
    "fire at most 3 times and never for longer than 1 s": [
        "keep times(fire) <= 3",
        "avoid time_holding(fire) > 1 s",
    ],
    "keep fire implies spray if not boss_dead": ["keep fire and not boss_dead implies spray"],
    "if fire then spray, if not, boss_dead": ["keep fire implies spray", "keep not fire implies boss_dead"],
    "avoid fire except in the first 2 s of spray": ["keep fire implies spray and time_holding(spray) < 2 s"],
    "avoid fire unless spray began more than 1 s ago": [
        "keep fire implies once begins spray and time_since(begins spray) > 1 s"
    ],
    "when spray, at most 2 fire in any 3 s": ["keep spray implies times_within(fire, 3 s) <= 2"],
    "fire only after at most 3 spray since the last fire": [
        "keep begins fire implies not previously (times_since(spray, fire) > 3)"
    ],
    "once phase is menu, phase is never results again": ["keep phase is menu implies always phase is not results"],
    "when fire is off, spray": ["keep not fire implies spray"],
    "health never drops by more than 15 from one step to the next": ["keep health >= previous(health) - 15"],
    "keep at least 2 s between begins fire and the next begins fire": [
        "avoid (begins fire) then within 2 s (begins fire)"
    ],
    "once fire has begun it stays on until not spray": ["keep begins fire implies (fire weak_until not spray)"],
    "keep between two fire at least one spray": [
        "keep begins fire and previously once fire implies previously (times_since(spray, begins fire) >= 1)"
    ],
    "check that fire and spray never happen together": ["avoid fire and spray"],
    "fire before spray before boss_dead": ["reach fire then spray then boss_dead"],
    "require at the end fire and health >= 30": ["require eventually always (fire and health >= 30)"],
    "keep fire implies health <= 5 except in the first 1 s": ["keep time_holding(fire) >= 1 s implies health <= 5"],
}
SEVERAL = {
    "whenever fire then spray or boss_dead within 5 s unless phase is menu": [
        "keep fire implies phase is menu or (eventually within 5 s (spray or boss_dead))",
        "keep fire implies eventually within 5 s (spray or boss_dead or phase is menu)",
    ],
    "whenever fire && spray, boss_dead within 2 frames unless state == Dead": [
        "keep fire and spray implies state is Dead or (eventually within 2 steps boss_dead)",
        "keep fire and spray implies eventually within 2 steps (boss_dead or state is Dead)",
    ],
    "reach fire and spray exactly once": [
        "reach times(fire and spray) >= 1",
        "keep times(fire and spray) <= 1",
    ],
    "no second fire within 10 s": [
        "avoid (begins fire) then within 10 s (begins fire)",
        "avoid fire then within 10 s fire",
        "keep ends fire implies always for 10 s not fire",
    ],
    "keep begins fire implies spray held for 4 s": [
        "keep begins fire implies time_holding(spray) >= 4 s",
        "keep begins fire implies always for 4 s spray",
    ],
    "reach fire within 15 min and health >= 4 and spray": [
        "require eventually within 15 min (fire and health >= 4 and spray)",
        "reach health >= 4 and spray",
    ],
    "while fire, spray and not boss_dead, except when health <= 5": [
        "keep fire implies spray and not boss_dead or health <= 5",
        "keep fire implies spray and (not boss_dead or health <= 5)",
    ],
    "keep health < previous(health) and previous(health) - health <= 1 unless fire": [
        "keep (health < previous(health) and previous(health) - health <= 1) or fire",
        "keep health < previous(health) and (previous(health) - health <= 1 or fire)",
    ],
    "from fire until spray or boss_dead health does not change": [
        "keep begins fire implies ((health >= previous(health) and health <= previous(health)) weak_until "
        "(spray or boss_dead))",
        "keep begins fire implies spray or boss_dead or weak_next ((health >= previous(health) and health <= "
        "previous(health)) weak_until (spray or boss_dead))",
    ],
    "when times_since(fire, ends spray) >= 3 then boss_dead for 6 s": [
        "keep begins (times_since(fire, ends spray) >= 3) implies always for 6 s boss_dead",
        "keep times_since(fire, ends spray) >= 3 implies always for 6 s boss_dead",
    ],
    "keep fire implies exactly one of spray, boss_dead within 1 s": [
        "keep fire implies (eventually within 1 s (spray or boss_dead)) and ((always for 1.1 s not spray) or "
        "(always for 1.1 s not boss_dead))",
        "keep fire implies eventually within 1 s ((spray and not boss_dead) or (not spray and boss_dead))",
    ],
    "keep begins fire implies spray at least 5 s and at most 20 s before": [
        "keep begins fire implies times_within(spray, 20 s, 10) > times_within(spray, 4.9 s, 10)"
    ],
    "keep begins fire implies once between 2 s and 5 s ago begins spray": [
        "keep begins fire implies times_within(spray, 5 s, 10) > times_within(spray, 1.9 s, 10)"
    ],
    "keep fire implies spray happened since the last fire": [
        "keep fire implies previously (not fire since (spray and not fire))",
        "keep fire implies spray or previously (not fire since (spray and not fire))",
    ],
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
        "keep begins fire implies eventually within 10 s spray",
        "keep spray and (begins fire or begins spray) and once within 10 s begins fire implies "
        "(not boss_dead weak_until fire)",
        "keep spray and (begins fire or begins spray) and once within 10 s begins fire implies "
        "(not boss_dead until fire)",
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


@pytest.mark.parametrize(("ago", "kept"), [(1, False), (2, True), (5, True), (6, False)])
def test_a_window_before_an_event_has_its_first_and_its_last_step(ago: int, kept: bool) -> None:
    (text,) = SEVERAL["keep begins fire implies once between 2 s and 5 s ago begins spray"]
    (fspa,) = tltlc.compile_text(f"{HEAD.replace('10 Hz', '1 Hz')}spec s {{ {text.replace('1.9 s', '1 s')} }}")
    monitor = Monitor(fspa)
    rest = {"boss_dead": 0, "coins": 0, "lap": 0, "health": 1, "phase": 0, "state": 0}
    for step in range(ago + 1):
        result = monitor.step({"fire": step == ago, "spray": step == 0, **rest})
    assert (result.verdict != "violated") is kept


def test_the_last_value_of_an_enum_may_have_been_followed_by_nothing() -> None:
    head = "clock 10 Hz\nsignal fire: bool\nsignal note: (none, left, right)\n"
    source = SourceFile("a.tltl", f"{head}spec s {{\nkeep begins fire implies last note is left\n}}\n")
    assert errors(source)[0].help == "write `keep begins fire implies ((note is not right) since note is left)`"


def test_a_number_of_the_game_has_no_unit() -> None:
    (error,) = errors(SourceFile("a.tltl", f"{HEAD}spec s {{\navoid fire and health > 80 hp\n}}\n"))
    assert (error.code, error.fixes[0].edits[0].text) == ("TLT0111", "80")
    text = "signal load in [0, 5] kg\nsignal mass in [0 kg, 5 kg]\nspec s { reach load > 1 and mass > 1 }\n"
    assert [error.help for error in errors(SourceFile("a.tltl", text))] == [
        "write `signal load in [0, 5]`",
        "write `signal mass in [0, 5]`",
    ]


def test_a_remainder_is_said_to_be_missing() -> None:
    (error,) = errors(SourceFile("a.tltl", f"{HEAD}spec s {{\nkeep times(fire) % 3 == 0 implies spray\n}}\n"))
    assert (error.help or "").startswith("there is no remainder")


@pytest.mark.parametrize(
    "typed",
    [
        "fire only if fire was at least 2 s ago",
        "after spray, exactly 2 fire within 3 s",
        "when fire, spray within 2 s, otherwise boss_dead",
        "when fire, doors cannot open within 4 s",
        "spray or bombs forbidden",
    ],
)
def test_a_sentence_that_a_clause_would_miss_gets_none(typed: str) -> None:
    (error,) = errors(SourceFile("a.tltl", f"{HEAD}spec s {{\n{typed}\n}}\n"))
    assert error.fixes == ()
    assert "`keep fire" not in (error.help or "")
    assert "in place of" not in (error.help or "")
