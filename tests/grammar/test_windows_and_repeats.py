"""Sentences with windows after an event, limits on the last seconds, and what must not or must come again."""

from __future__ import annotations

import pytest

from tests.grammar.sentences import read
from tltlc.grammar.mistakes.sentences.validity import is_valid

READINGS: dict[str, list[tuple[str, ...]]] = {
    "keep begins (times_within(fire, 5 s) >= 3) implies no fire for the next 3 s": [
        ("keep begins (times_within(fire, 5 s) >= 3) implies weak_next always for 3 s not fire", ""),
    ],
    "keep begins (times_within(fire, 5 s) >= 3) implies no fire for 3 s": [
        ("keep begins (times_within(fire, 5 s) >= 3) implies weak_next always for 3 s not fire", ""),
    ],
    "keep begins (times(fire) >= 3) implies no fire for 3 s": [
        ("keep begins (times(fire) >= 3) implies weak_next always for 3 s not fire", ""),
    ],
    "after the third fire, no fire for 3 s": [
        ("keep begins (times(fire) >= 3) implies weak_next always for 3 s not fire", ""),
    ],
    "keep fire at least once and at most 3 times between two begins spray": [
        (
            "keep begins spray and previously once spray implies previously (times_since(fire, begins spray) >= 1)",
            "keep times_since(fire, begins spray) <= 3",
            "",
        ),
    ],
    "keep fire at least once and at most 3 times between two spray": [
        (
            "keep begins spray and previously once spray implies previously (times_since(fire, begins spray) >= 1)",
            "keep times_since(fire, spray) <= 3",
            "",
        ),
    ],
    "keep at least 1 and at most 3 fire between two spray": [
        (
            "keep begins spray and previously once spray implies previously (times_since(fire, begins spray) >= 1)",
            "keep times_since(fire, spray) <= 3",
            "",
        ),
    ],
    "reach boss_dead then fire for 2 s without spray": [
        ("reach boss_dead then time_holding(fire) >= 2 s", "avoid spray", "if `spray` must hold at no step of play"),
        (
            "reach boss_dead and not spray and next (not spray until (time_holding(fire) >= 2 s and not spray))",
            "if no step from one with `boss_dead` to `time_holding(fire) >= 2 s` may have it, these two included",
        ),
        (
            "reach boss_dead and next (not spray until time_holding(fire) >= 2 s)",
            "if only no step between `boss_dead` and `time_holding(fire) >= 2 s` may have it",
        ),
        ("reach boss_dead then time_holding(fire and not spray) >= 2 s", "if `spray` must not hold in those 2 s"),
    ],
    "reach lap == 3 then fire for 2 s without spray": [
        ("reach lap == 3 then time_holding(fire) >= 2 s", "avoid spray", "if `spray` must hold at no step of play"),
        (
            "reach lap == 3 and not spray and next (not spray until (time_holding(fire) >= 2 s and not spray))",
            "if no step from `lap == 3` to `time_holding(fire) >= 2 s` may have it, these two included",
        ),
        (
            "reach lap == 3 and next (not spray until time_holding(fire) >= 2 s)",
            "if only no step between `lap == 3` and `time_holding(fire) >= 2 s` may have it",
        ),
        ("reach lap == 3 then time_holding(fire and not spray) >= 2 s", "if `spray` must not hold in those 2 s"),
    ],
    "reach lap == 3 then fire without spray in between": [
        (
            "reach lap == 3 and not spray and next (not spray until (fire and not spray))",
            "if no step from `lap == 3` to `fire` may have it, these two included",
        ),
        ("reach lap == 3 and next (not spray until fire)", "if only no step between `lap == 3` and `fire` may have it"),
    ],
    "keep begins fire implies eventually within 4 s health >= 100 unless not fire": [
        (
            "keep begins fire implies eventually within 4 s (health >= 100 or not fire)",
            "if `not fire` in that time is enough",
        ),
    ],
    "keep begins fire and coins > 8 implies health drops by at least 10 within 0.5 s": [
        (
            "keep begins fire and coins > 8 implies eventually within 0.5 s health <= value_at(health, "
            "begins fire and coins > 8) - 10",
            "if it is compared with its value at `begins fire and coins > 8`",
        ),
        (
            "keep begins fire and coins > 8 implies eventually within 0.5 s health <= "
            "value_at(previous(health), begins fire and coins > 8) - 10",
            "if it is compared with its value at the step before",
        ),
        (
            "keep begins fire and coins > 8 implies eventually within 0.5 s health <= previous(health) - 10",
            "if it must change so much from one step to the next",
        ),
    ],
    "keep after the third fire, spray before the next fire": [
        ("keep begins (times(fire) >= 4) implies once (spray and times(fire) >= 3)", ""),
    ],
    "after the third fire, spray before the next fire": [
        ("keep begins (times(fire) >= 4) implies once (spray and times(fire) >= 3)", ""),
    ],
    "after each fire, spray before the next fire": [
        ("keep times_since(fire, begins spray) <= 1", ""),
    ],
    "avoid spray within 3 s before or after fire": [
        ("avoid spray and once within 3 s fire", "avoid fire and once within 3 s spray", ""),
    ],
    "no spray within 3 s before or after fire": [
        ("avoid spray and once within 3 s fire", "avoid fire and once within 3 s spray", ""),
    ],
    "keep boss_dead implies never fire and health never below 30": [
        ("keep boss_dead implies not once fire and not once health < 30", "if it is about what came up to that step"),
        ("keep boss_dead implies always (not fire and health >= 30)", "if it is about what comes from that step on"),
    ],
    "keep boss_dead implies never fire and never spray": [
        ("keep boss_dead implies not once fire and not once spray", "if it is about what came up to that step"),
        ("keep boss_dead implies always (not fire and not spray)", "if it is about what comes from that step on"),
    ],
    "keep boss_dead implies never fire and health >= 30": [
        ("keep boss_dead implies health >= 30 and not once fire", "if no `fire` may have come up to that step"),
        ("keep boss_dead implies health >= 30 and always not fire", "if no `fire` may come from that step on"),
        ("avoid boss_dead and (fire and health >= 30)", "for each step with `boss_dead`"),
        ("keep boss_dead implies always not (fire and health >= 30)", "if it holds from then on"),
    ],
    "keep health < 20 for 30 s implies eventually within 5 s begins spray": [
        (
            "keep begins (time_holding(health < 20) >= 30 s) implies eventually within 5 s begins spray",
            "if once each time that this begins",
        ),
        (
            "keep time_holding(health < 20) >= 30 s implies eventually within 5 s begins spray",
            "if anew at each step while it lasts",
        ),
    ],
    "at the end times(fire) == times(spray)": [
        ("require eventually always times(fire, 1000) == times(spray, 1000)", ""),
    ],
    "keep ends fire implies spray or fire for at least 60 s": [
        (
            "keep ends fire implies previously time_holding(fire) >= 60 s or spray",
            "if `fire` must have held for 60 s by then",
        ),
        ("keep ends fire implies always for 60 s (spray or fire)", ""),
    ],
    "keep begins fire implies spray between 1 s and 3 s later": [
        (
            "keep begins fire implies (always for 1 s not spray) and eventually within 3 s spray",
            "if `spray` must not come earlier",
        ),
        (
            "keep ends (once within 29 steps begins fire) implies once within 2 s spray",
            "if `spray` may come earlier, and `begins fire` does not come again within 3 s",
        ),
    ],
    "keep begins fire implies begins spray between 1 s and 3 s later": [
        (
            "keep begins fire implies (always for 1 s not begins spray) and eventually within 3 s begins spray",
            "if `begins spray` must not come earlier",
        ),
        (
            "keep ends (once within 29 steps begins fire) implies once within 2 s begins spray",
            "if `begins spray` may come earlier, and `begins fire` does not come again within 3 s",
        ),
    ],
    "keep begins fire implies spray between 0.1 s and 0.3 s later": [
        ("keep begins fire implies next after 0.1 s eventually within 0.2 s spray", ""),
    ],
    "keep fire implies spray no earlier than 15 s and no later than 25 s later": [
        (
            "keep fire implies (always for 15 s not spray) and eventually within 25 s spray",
            "if `spray` must not come earlier",
        ),
        (
            "keep ends (once within 249 steps fire) implies once within 10 s spray",
            "if `spray` may come earlier, and `fire` does not come again within 25 s",
        ),
    ],
    "keep begins fire implies spray no earlier than 0.2 s and no later than 0.4 s later": [
        (
            "keep begins fire implies (always for 0.2 s not spray) and next after 0.2 s eventually within 0.2 s spray",
            "if `spray` must not come earlier",
        ),
        ("keep begins fire implies next after 0.2 s eventually within 0.2 s spray", "if `spray` may come earlier, too"),
    ],
    "keep ends fire implies spray between 2 s and 6 s later unless fire": [
        (
            "keep ends fire implies ((always for 2 s not spray) or (not spray until fire)) and "
            "eventually within 6 s (spray or fire)",
            "if `spray` must not come earlier",
        ),
        (
            "keep ends (once within 59 steps ends fire) implies once within 4 s spray or once within 6 s fire",
            "if `spray` may come earlier, and `ends fire` does not come again within 6 s",
        ),
    ],
    "keep ends fire implies spray between 2 s and 6 s later unless boss_dead": [
        (
            "keep ends fire implies ((always for 2 s not spray) or (not spray until boss_dead)) and "
            "eventually within 6 s (spray or boss_dead)",
            "if `spray` must not come earlier",
        ),
        (
            "keep ends (once within 59 steps ends fire) implies once within 4 s spray or once within 6 s boss_dead",
            "if `spray` may come earlier, and `ends fire` does not come again within 6 s",
        ),
    ],
    "spray between 2 s and 6 s after fire": [
        (
            "keep fire implies (always for 2 s not spray) and eventually within 6 s spray",
            "if `spray` must not come earlier",
        ),
        (
            "keep ends (once within 59 steps fire) implies once within 4 s spray",
            "if `spray` may come earlier, and `fire` does not come again within 6 s",
        ),
    ],
    "keep health >= highest_within(health, 1 s) - 5 unless boss_dead": [
        (
            "keep health >= highest_within(health, 1 s) - 5 or once within 1 s boss_dead",
            "if it excuses what comes up to 1 s later, too",
        ),
        ("keep health >= highest_within(health, 1 s) - 5 or boss_dead", "if `boss_dead` counts at its own step alone"),
    ],
    "keep health >= highest_within(health, 1 s) - 5 except during phase menu": [
        (
            "keep health >= highest_within(health, 1 s) - 5 or once within 1 s phase is menu",
            "if it excuses what comes up to 1 s later, too",
        ),
        (
            "keep health >= highest_within(health, 1 s) - 5 or phase is menu",
            "if `phase is menu` counts at its own step alone",
        ),
    ],
    "keep times_within(fire, 5 s) <= 3 unless boss_dead": [
        (
            "keep times_within(fire, 5 s) <= 3 or once within 5 s boss_dead",
            "if it excuses what comes up to 5 s later, too",
        ),
        ("keep times_within(fire, 5 s) <= 3 or boss_dead", "if `boss_dead` counts at its own step alone"),
    ],
    "keep health never drops by more than 8 within 0.5 s unless fire": [
        (
            "keep health >= highest_within(health, 0.5 s) - 8 or once within 0.5 s fire",
            "if it excuses what comes up to 0.5 s later, too",
        ),
        ("keep health >= highest_within(health, 0.5 s) - 8 or fire", "if `fire` counts at its own step alone"),
    ],
    "avoid times_within(fire, 5 s) > 3 unless boss_dead": [
        (
            "keep times_within(fire, 5 s) > 3 implies once within 5 s boss_dead",
            "if it excuses what comes up to 5 s later, too",
        ),
        ("keep times_within(fire, 5 s) > 3 implies boss_dead", "if `boss_dead` counts at its own step alone"),
    ],
    "keep phase is menu implies health >= previous(health, 1 s) - 5 unless fire": [
        (
            "keep phase is menu implies health >= previous(health, 1 s) - 5 or once within 1 s fire",
            "if it excuses what comes up to 1 s later, too",
        ),
        (
            "keep phase is menu implies health >= previous(health, 1 s) - 5 or fire",
            "if `fire` counts at its own step alone",
        ),
    ],
}


@pytest.mark.parametrize("typed", READINGS)
def test_a_sentence_has_these_readings(typed: str) -> None:
    assert [(*reading.clauses, reading.condition) for reading in read(typed).readings] == READINGS[typed]
    assert all(is_valid(reading.clauses) for reading in read(typed).readings)
