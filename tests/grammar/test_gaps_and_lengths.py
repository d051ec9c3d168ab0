"""Sentences about the gap between two events, how long something lasts, and how often it comes."""

from __future__ import annotations

import pytest

from tests.grammar.sentences import read
from tltlc.grammar.mistakes.sentences.validity import is_valid

READINGS: dict[str, list[tuple[str, ...]]] = {
    "between any two fire, spray": [
        (
            "keep begins fire and previously once fire implies previously (not begins fire since "
            "(spray and not begins fire))",
            "if it must come at some step between them",
        ),
        ("keep not fire and previously once fire implies spray", "if it must hold at every step between them"),
    ],
    "keep between ends fire and begins fire at least one spray": [
        ("keep begins fire and previously once fire implies previously (not fire since (spray and not fire))", ""),
    ],
    "keep between ends (phase is shift) and begins (phase is shift) at least one spray": [
        (
            "keep begins (phase is shift) and previously once (phase is shift) implies previously (not "
            "(phase is shift) since (spray and not (phase is shift)))",
            "",
        ),
    ],
    "between ends fire and begins fire at least once spray": [
        ("keep begins fire and previously once fire implies previously (not fire since (spray and not fire))", ""),
    ],
    "keep at most one spray between ends fire and begins fire": [
        ("keep (not begins fire since ends fire) implies times_since(spray, ends fire) <= 1", ""),
    ],
    "between two fire there must be at least one spray": [
        ("keep begins fire and previously once fire implies previously (times_since(spray, begins fire) >= 1)", ""),
    ],
    "state is Dead ends at most 8 s after the last fire": [
        (
            "keep state is Dead implies once within 8 s fire",
            "if `state is Dead` may hold only up to 8 s after a `fire`, the last one",
        ),
        (
            "keep fire and state is Dead implies eventually within 8 s state is not Dead",
            "if it must have ended once within 8 s after each `fire`",
        ),
    ],
    "fire must end within 8 s after the last spray": [
        ("keep fire implies once within 8 s spray", "if `fire` may hold only up to 8 s after a `spray`, the last one"),
        (
            "keep spray and fire implies eventually within 8 s not fire",
            "if it must have ended once within 8 s after each `spray`",
        ),
    ],
    "every fire lasts exactly 4 s unless spray": [
        (
            "keep begins fire implies (always for 4 s fire) or (fire until spray)",
            "avoid time_holding(fire) > 4 s and not spray",
            "",
        ),
    ],
    "fire lasts exactly 4 s": [
        ("keep begins fire implies always for 4 s fire", "avoid time_holding(fire) > 4 s", ""),
    ],
    "fire lasts exactly 4 s unless spray": [
        (
            "keep begins fire implies (always for 4 s fire) or (fire until spray)",
            "avoid time_holding(fire) > 4 s and not spray",
            "",
        ),
    ],
    "keep fire every 5 min +- 5 s": [
        (
            "avoid (begins fire) then within 2949 steps (begins fire)",
            "keep time_holding(not begins fire) <= 304.8 s",
            "",
        ),
    ],
    "keep fire every 10 s plus or minus 1 s": [
        ("avoid (begins fire) then within 89 steps (begins fire)", "keep time_holding(not begins fire) <= 10.8 s", ""),
    ],
    "keep fire every 10 s give or take 1 s": [
        ("avoid (begins fire) then within 89 steps (begins fire)", "keep time_holding(not begins fire) <= 10.8 s", ""),
    ],
    "keep begins fire implies within 10 s spray and stays so until boss_dead": [
        (
            "keep begins fire implies eventually within 10 s spray",
            "keep spray and (begins fire or begins spray) and once within 10 s begins fire implies "
            "(spray weak_until boss_dead)",
            "if play may end before `boss_dead`",
        ),
        (
            "keep begins fire implies eventually within 10 s spray",
            "keep spray and (begins fire or begins spray) and once within 10 s begins fire implies "
            "(spray until boss_dead)",
            "if `boss_dead` must come",
        ),
    ],
    "keep begins (times_within(fire, 2 min) >= 3) implies spray within 10 s then lap == 3 until boss_dead": [
        (
            "keep begins (times_within(fire, 2 min) >= 3) implies eventually within 10 s spray",
            "keep spray and (begins (times_within(fire, 2 min) >= 3) or begins spray) and once within "
            "10 s begins (times_within(fire, 2 min) >= 3) implies (lap == 3 weak_until boss_dead)",
            "if play may end before `boss_dead`",
        ),
        (
            "keep begins (times_within(fire, 2 min) >= 3) implies eventually within 10 s spray",
            "keep spray and (begins (times_within(fire, 2 min) >= 3) or begins spray) and once within "
            "10 s begins (times_within(fire, 2 min) >= 3) implies (lap == 3 until boss_dead)",
            "if `boss_dead` must come",
        ),
    ],
    "after fire, spray then boss_dead within 5 s": [
        (
            "keep begins fire implies eventually within 5 s (boss_dead and not begins fire and "
            "previously (not begins fire since spray))",
            "if the time counts from where `fire` begins, anew from each",
        ),
        (
            "keep begins fire implies eventually (spray and eventually within 5 s boss_dead)",
            "if it counts from `spray`",
        ),
    ],
}


@pytest.mark.parametrize("typed", READINGS)
def test_a_sentence_has_these_readings(typed: str) -> None:
    assert [(*reading.clauses, reading.condition) for reading in read(typed).readings] == READINGS[typed]
    assert all(is_valid(reading.clauses) for reading in read(typed).readings)
