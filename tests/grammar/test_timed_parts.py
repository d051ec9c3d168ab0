"""Sentences with times, counts and ordinals in several parts: `b for 3 s and c within 6 s`, `every third a`."""

from __future__ import annotations

import pytest

from tests.grammar.sentences import read
from tltlc.grammar.mistakes.sentences.validity import is_valid

READINGS: dict[str, list[tuple[str, ...]]] = {
    "on every third fire, spray within 1 s": [
        (
            "keep begins fire and (times(fire) == 3 or times(fire) == 6 or times(fire) == 9) implies "
            "eventually within 1 s spray",
            "up to number 9: no clause counts for ever",
        ),
    ],
    "spray within 1 s after every third fire": [
        (
            "keep begins fire and (times(fire) == 3 or times(fire) == 6 or times(fire) == 9) implies "
            "eventually within 1 s spray",
            "up to number 9: no clause counts for ever",
        ),
    ],
    "on the third fire, spray within 1 s": [
        ("keep begins (times(fire) >= 3) implies eventually within 1 s spray", ""),
    ],
    "reach fire then spray 3 times then boss_dead within 10 min": [
        (
            "require eventually within 10 min (boss_dead and previously once (begins spray and "
            "previously once (begins spray and previously once (begins spray and previously once "
            "fire))))",
            "if the time is for all of them, from the first step of play on",
        ),
        (
            "reach fire then begins spray then begins spray then begins spray then (boss_dead and once "
            "within 10 min begins fire)",
            "if it is for all of them, from where `fire` begins, the last time if it begins again",
        ),
    ],
    "reach fire then spray then boss_dead, all within 10 min": [
        (
            "require eventually within 10 min (boss_dead and previously once (spray and previously once fire))",
            "if the time is for all of them, from the first step of play on",
        ),
        (
            "reach fire then spray then (boss_dead and once within 10 min begins fire)",
            "if it is for all of them, from where `fire` begins, the last time if it begins again",
        ),
    ],
    "reach fire and spray, all within 3 min": [
        ("require eventually within 3 min fire", "require eventually within 3 min spray", ""),
    ],
    "keep begins fire implies fire for at least 3 s and spray within 6 s": [
        ("keep begins fire implies always for 3 s fire", "keep begins fire implies eventually within 6 s spray", ""),
    ],
    "keep begins fire implies fire for 3 s and spray within 6 s unless boss_dead": [
        (
            "keep begins fire implies (always for 3 s fire) or (fire until boss_dead)",
            "keep begins fire implies eventually within 6 s (spray or boss_dead)",
            "",
        ),
    ],
    "keep begins fire implies (boss_dead for 8 steps then not boss_dead)": [
        ("keep begins fire implies (always for 8 steps boss_dead) and weak_next after 8 steps not boss_dead", ""),
    ],
    "keep begins fire implies (eventually within 1.5 s coins == 30) unless spray": [
        (
            "keep begins fire implies spray or (eventually within 1.5 s coins == 30)",
            "if `spray` counts only at the first step of that time",
        ),
        (
            "keep begins fire implies eventually within 1.5 s (coins == 30 or spray)",
            "if `spray` in that time is enough",
        ),
    ],
    "keep ends fire implies (within 5 s spray) or boss_dead": [
        ("keep ends fire implies (eventually within 5 s spray) or boss_dead", ""),
    ],
    "fire for at most 20 s and at least 5 s": [
        ("keep begins fire implies always for 5 s fire", "avoid time_holding(fire) > 20 s", ""),
    ],
    "keep at the end total_time(fire) >= 80 % of the time": [
        (
            "require eventually always total_time(fire, 10 min) >= 0.8 * total_time(true, 10 min)",
            "if no play is longer than 10 min",
        ),
    ],
    "keep fire implies lap >= 3 and (never spray or never boss_dead)": [
        (
            "keep fire implies lap >= 3 and (not once spray or not once boss_dead)",
            "if it is about what came up to that step",
        ),
        (
            "keep fire implies lap >= 3 and ((always not spray) or (always not boss_dead))",
            "if it is about what comes from that step on",
        ),
    ],
    "keep fire only if never spray": [
        ("keep fire implies not once spray", ""),
    ],
    "avoid begins fire less than 3 s after ends spray": [
        ("keep ends spray implies always for 3 s not begins fire", ""),
    ],
    "keep begins (health < 20) implies lap <= 5 within 1 s as long as health < 20": [
        (
            "keep time_holding(health < 20) >= 1 s implies lap <= 5",
            "if `lap <= 5` must hold from 1 s on, as long as `health < 20` does",
        ),
        (
            "keep begins (health < 20) implies eventually within 1 s lap <= 5",
            "if `lap <= 5` at one step of that time is enough",
        ),
    ],
    "when health < 20, lap <= 5 within 1 s and stays so while boss_dead": [
        ("keep health < 20 implies eventually within 1 s (lap <= 5 and (lap <= 5 weak_until not boss_dead))", ""),
    ],
    "keep health never drops by more than 8 within 0.5 s": [
        ("keep health >= highest_within(health, 0.5 s) - 8", ""),
    ],
    "health may not rise by more than 8 in any 2 s": [
        ("keep health <= lowest_within(health, 2 s) + 8", ""),
    ],
    "when fire begins, spray must have been true for 2 s": [
        ("keep begins fire implies time_holding(spray) >= 2 s", ""),
    ],
    "keep begins fire implies spray has been true for 2 s": [
        ("keep begins fire implies time_holding(spray) >= 2 s", "if `spray` has held for 2 s up to that step"),
        ("keep begins fire implies always for 2 s spray", "if it holds from that step on"),
    ],
    "keep boss_dead not before 30 s": [
        ("require always for 30 s not boss_dead", ""),
    ],
    "no fire during the last 10 s of phase shift": [
        (
            "keep ends phase is shift implies not previously once within 99 steps (fire and phase is shift)",
            "where `phase is shift` has ended",
        ),
    ],
    "keep fire in the last 10 s of phase shift": [
        (
            "keep ends phase is shift implies not previously once within 99 steps (not fire and phase is shift)",
            "where `phase is shift` has ended",
        ),
    ],
    "keep fire for the first 5 s of phase shift": [
        ("keep phase is shift and time_holding(phase is shift) < 5 s implies fire", ""),
    ],
    "keep time since lap changed <= 40 s": [
        (
            "keep once lap != previous(lap) implies time_since(lap != previous(lap)) <= 40 s",
            "if it counts from the first `lap != previous(lap)` on",
        ),
        ("keep time_holding(lap == previous(lap)) <= 40 s", "if it counts from the first step of play on"),
    ],
    "avoid spray and not fire unless ends fire within the last 0.5 s": [
        (
            "avoid (spray and not fire) and not once within 0.5 s ends fire",
            "if all of `once within 0.5 s ends fire` is an exception of all before it",
        ),
    ],
    "keep begins fire implies not fire for the last 4 s before or boss_dead": [
        ("keep begins fire implies previously time_holding(not fire) >= 4 s or boss_dead", ""),
    ],
    "keep first fire implies at least 15 s since begins phase is shift": [
        ("keep begins (once fire) implies time_since(begins (phase is shift)) >= 15 s", ""),
    ],
    "avoid fire then within 2 s boss_dead without spray in between": [
        ("avoid boss_dead and previously (not spray since fire) and previously once within 19 steps fire", ""),
    ],
    "keep ends fire implies not fire weak_until (spray or 20 s passed)": [
        ("keep ends fire implies (always for 20 s not fire) or (not fire weak_until spray)", ""),
    ],
    "keep health < 40 implies at most 1 fire every 30 s": [
        ("keep health < 40 implies times_within(fire, 30 s) <= 1", ""),
    ],
    "keep no two fire within 8 s": [
        ("avoid (begins fire) then within 8 s (begins fire)", "if steps in a row count once"),
        ("avoid fire then within 8 s fire", "if each step counts"),
    ],
    "always while boss_dead not fire": [
        ("keep boss_dead implies not fire", ""),
    ],
}


@pytest.mark.parametrize("typed", READINGS)
def test_a_sentence_has_these_readings(typed: str) -> None:
    assert [(*reading.clauses, reading.condition) for reading in read(typed).readings] == READINGS[typed]
    assert all(is_valid(reading.clauses) for reading in read(typed).readings)


@pytest.mark.parametrize(
    "typed",
    [
        "keep begins fire implies always for 1 s not fire unless fire again",  # what it forbids excuses it
        "keep total_time(fire) >= 80 % of the work",
        "keep fire implies (never spray or lap >= 3)",
    ],
)
def test_other_sentences_have_none(typed: str) -> None:
    assert read(typed).readings == ()
