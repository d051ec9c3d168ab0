"""Sentences about orders and times since an event, and answers that must hold until something has lasted."""

from __future__ import annotations

import pytest

from tests.grammar.sentences import read
from tltlc.grammar.mistakes.sentences.validity import is_valid

READINGS: dict[str, list[tuple[str, ...]]] = {
    "keep ends fire after fire for at least 1 s implies spray within 0.1 s": [
        ("keep ends fire and previously (time_holding(fire) >= 1 s) implies eventually within 0.1 s spray", ""),
    ],
    "keep once fire implies never spray until boss_dead": [
        ("keep fire implies (not spray weak_until boss_dead)", "if it is asked for at each of its steps alone"),
        ("keep once fire implies (not spray weak_until boss_dead)", "if it is asked for again at every later step"),
    ],
    "keep total_time(fire) <= 20 % of the episode": [
        (
            "require eventually always total_time(fire, 10 min) <= 0.2 * total_time(true, 10 min)",
            "if it counts when play ends, and no play is longer than 10 min",
        ),
        (
            "keep total_time(fire, 10 min) <= 0.2 * total_time(true, 10 min)",
            "if it must be so at each step, and no play is longer than 10 min",
        ),
    ],
    "keep begins fire implies lap <= 5 within 1.5 s and then lap <= 5 until not boss_dead for 3 s": [
        (
            "keep begins fire implies eventually within 1.5 s (lap <= 5 and (lap <= 5 weak_until "
            "time_holding(not boss_dead) >= 3 s))",
            "if play may end before `time_holding(not boss_dead) >= 3 s`",
        ),
        (
            "keep begins fire implies eventually within 1.5 s (lap <= 5 and (lap <= 5 until "
            "time_holding(not boss_dead) >= 3 s))",
            "if `time_holding(not boss_dead) >= 3 s` must come",
        ),
    ],
    "keep begins fire implies lap <= 5 within 1.5 s and stays so until not boss_dead for 3 s": [
        (
            "keep begins fire implies eventually within 1.5 s (lap <= 5 and (lap <= 5 weak_until "
            "time_holding(not boss_dead) >= 3 s))",
            "if play may end before `time_holding(not boss_dead) >= 3 s`",
        ),
        (
            "keep begins fire implies eventually within 1.5 s (lap <= 5 and (lap <= 5 until "
            "time_holding(not boss_dead) >= 3 s))",
            "if `time_holding(not boss_dead) >= 3 s` must come",
        ),
    ],
    "while phase is menu, spray at least every 4 s": [
        ("keep time_holding(phase is menu and not spray) < 4 s", "if play may end in the middle of that time"),
        (
            "keep phase is menu implies eventually within 4 s (spray or phase is not menu)",
            "if play must not end before `spray`",
        ),
    ],
    "while phase is menu, spray at least once every 4 s": [
        ("keep time_holding(phase is menu and not spray) < 4 s", "if play may end in the middle of that time"),
        (
            "keep phase is menu implies eventually within 4 s (spray or phase is not menu)",
            "if play must not end before `spray`",
        ),
    ],
    "keep phase is results implies spray or 60 s after fire": [
        ("keep phase is results implies spray or (once fire and time_since(fire) >= 60 s)", ""),
    ],
    "keep fire implies spray then boss_dead then coins >= 3 since the last fire": [
        (
            "keep begins fire implies previously (not begins fire since (coins >= 3 and not begins "
            "fire and previously (not begins fire since (boss_dead and not begins fire and previously "
            "(not begins fire since spray))) and not begins fire))",
            "",
        ),
    ],
    "keep fire implies spray then boss_dead since last fire": [
        (
            "keep begins fire implies previously (not begins fire since (boss_dead and not begins fire "
            "and previously (not begins fire since spray) and not begins fire))",
            "",
        ),
    ],
    "avoid begins fire and (boss_dead or within 5 s after ends boss_dead)": [
        ("avoid begins fire and (boss_dead or once within 5 s ends boss_dead)", ""),
    ],
    "avoid begins fire and within 5 s after ends boss_dead": [
        ("avoid begins fire and once within 5 s ends boss_dead", ""),
    ],
}


@pytest.mark.parametrize("typed", READINGS)
def test_a_sentence_has_these_readings(typed: str) -> None:
    assert [(*reading.clauses, reading.condition) for reading in read(typed).readings] == READINGS[typed]
    assert all(is_valid(reading.clauses) for reading in read(typed).readings)
