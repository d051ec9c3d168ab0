"""Sentences with an exception, with two cases, with a count or with several rules mean what they say."""

from __future__ import annotations

import pytest

import tltlc
from tests.grammar.phrases_as_typed import errors, fix, is_equivalent
from tests.grammar.sentences import HEAD, VARIES, read, spec
from tltlc.grammar.mistakes.sentences.validity import is_valid
from tltlc.monitor import Monitor

AGAIN = [
    "keep begins phase is shift implies weak_next (not begins phase is shift weak_until phase is menu)",
    "keep phase is shift implies weak_next (not phase is shift weak_until phase is menu)",
]
AFTER_A_STEP = "keep spray implies weak_next fire"
AFTER_THE_END = "keep ends spray implies fire"
NEVER_AFTER = ["avoid previously spray and fire", "avoid ends spray and fire"]
CHANGES_IN_5_S = ["keep times_within(begins fire, 5 s, 5) + times_within(ends fire, 5 s, 5) <= 4"]
COUNTED = ["keep begins fire implies previously (times_since(spray, fire) >= 3)"]
FOR_GOOD = ["keep spray implies eventually within 0.5 s always fire"]
SHORT_AND_LONG = ["keep begins fire implies always for 2 s fire", "avoid time_holding(fire) > 12 s"]
ENDED = "keep ends fire and time_since(begins fire) >= 1.5 s implies"
CASES = ["keep lap == 1 implies coins == 0", "keep lap != 1 implies coins > 0"]
BOTH_UNTIL = ["keep fire implies eventually within 5 s boss_dead", "keep fire implies (not spray until boss_dead)"]

FIXED = {
    # An exception.
    "avoid coins - lap > 6 unless fire or spray": ["avoid coins - lap > 6 and not (fire or spray)"],
    "avoid fire unless spray or boss_dead": ["avoid fire and not (spray or boss_dead)"],
    "keep fire implies spray unless boss_dead or coins > 3": ["keep fire implies spray or (boss_dead or coins > 3)"],
    "avoid (begins fire) then within 3 s (begins fire) unless once within 3 s spray": [
        "avoid (begins fire) then within 3 s ((begins fire) and not once within 3 s spray)"
    ],
    "avoid fire and spray except for the first 1 s of spray": ["avoid fire and time_holding(spray) >= 1 s"],
    "avoid fire while spray except in the first 1 s of spray": ["avoid fire and time_holding(spray) >= 1 s"],
    "no fire while spray except during the first 1 s": ["avoid fire and time_holding(spray) >= 1 s"],
    "avoid fire except for the first 5 steps of spray": ["keep fire implies spray and time_holding(spray) < 0.5 s"],
    "no fire in the first 3 steps of spray": ["avoid fire and spray and time_holding(spray) < 0.3 s"],
    "avoid fire except in the first 3 s": ["require weak_next after 3 s always not fire"],
    "avoid fire and spray unless spray began less than 1 s ago": [
        "avoid fire and spray and time_since(begins spray) >= 1 s"
    ],
    "keep phase == previous(phase) unless fire": [f"keep not ({VARIES}) or fire"],
    "avoid phase != previous(phase) unless fire": [f"keep {VARIES} implies fire"],
    "phase only changes when fire": [f"keep {VARIES} implies fire"],
    # Two cases.
    "keep lap == 1 implies coins == 0, otherwise coins > 0": CASES,
    "if lap == 1 then coins == 0 else coins > 0": CASES,
    "coins == 0 if lap == 1, otherwise coins > 0": CASES,
    "keep fire implies spray, otherwise no boss_dead": [
        "keep fire implies spray",
        "keep not fire implies not boss_dead",
    ],
    # Until something within a time, in brackets.
    "keep fire implies (not spray until boss_dead within 5 s)": BOTH_UNTIL,
    "keep fire implies (no spray until boss_dead within 5 s)": BOTH_UNTIL,
    "keep fire implies (not spray until within 5 s boss_dead)": BOTH_UNTIL,
    # How often a bool changes.
    "fire changes at most 4 times in any 5 s": CHANGES_IN_5_S,
    "keep fire toggles at most 4 times in any 5 s": CHANGES_IN_5_S,
    "at most 4 changes of fire in any 5 s": CHANGES_IN_5_S,
    "fire must not change more than 4 times in 5 s": CHANGES_IN_5_S,
    "avoid fire switching more than 4 times in 5 s": CHANGES_IN_5_S,
    "never more than 4 changes of fire in any 5 s": CHANGES_IN_5_S,
    "fire changes at most 4 times": ["keep times(begins fire, 5) + times(ends fire, 5) <= 4"],
    # A count since the last event of the same kind.
    "keep fire implies at least 3 spray since the last fire": COUNTED,
    "when fire, at least 3 spray since the last fire": COUNTED,
    "fire only after at least 3 spray since the last fire": COUNTED,
    "fire needs at least 3 spray since the last fire": COUNTED,
    "fire only after at least 3 spray since the last boss_dead": [
        "keep fire implies times_since(spray, boss_dead) >= 3"
    ],
    "when fire, at least 3 spray since the last boss_dead": ["keep fire implies times_since(spray, boss_dead) >= 3"],
    # For ever.
    "when spray then within 0.5 s fire for ever": FOR_GOOD,
    "when spray, fire within 0.5 s permanently": FOR_GOOD,
    "when spray, fire within 0.5 s and from then on": FOR_GOOD,
    "when spray, fire within 0.5 s until the end": FOR_GOOD,
    # How long something lasts.
    "keep fire takes between 2 s and 12 s": SHORT_AND_LONG,
    "keep fire lasts between 2 s and 12 s": SHORT_AND_LONG,
    "keep fire takes no less than 2 s and no more than 12 s": SHORT_AND_LONG,
    "when fire ends after at least 1.5 s, spray": [f"{ENDED} spray"],
    "when fire ends after at least 1.5 s, coins >= value_at(coins, begins fire) + 9 or health is full": [
        f"{ENDED} coins >= value_at(coins, begins fire) + 9 or health >= 100"
    ],
    "when phase is menu ends after more than 1 s, spray within 2 s": [
        "keep ends (phase is menu) and time_since(begins (phase is menu)) > 1 s implies eventually within 2 s spray"
    ],
    # Directly after something.
    "never phase is shift right after phase is menu": ["avoid previously phase is menu and phase is shift"],
    "avoid fire right after spray ends": ["avoid previously ends spray and fire"],
    "fire comes right after spray": ["keep begins fire implies previously spray"],
    "fire only right after spray": ["keep begins fire implies previously spray"],
    "reach fire right after spray": ["reach previously spray and fire"],
    # Several rules in one line.
    "avoid fire and spray, keep boss_dead while coins > 3, and avoid lap > 3": [
        "avoid fire and spray",
        "keep coins > 3 implies boss_dead",
        "avoid lap > 3",
    ],
    "keep fire implies spray, avoid boss_dead, and reach lap == 3": [
        "keep fire implies spray",
        "avoid boss_dead",
        "reach lap == 3",
    ],
}
"""Sentences with one reading, which the help offers as a fix."""

NAMED = {
    "avoid phase is shift again before phase is menu": AGAIN,
    "avoid fire right after spray": NEVER_AFTER,
    "no fire straight after spray": NEVER_AFTER,
    "avoid fire just after spray": NEVER_AFTER,
    "fire must not come immediately after spray": NEVER_AFTER,
    "right after spray, fire": [AFTER_A_STEP, AFTER_THE_END],
    "fire is right after spray": [AFTER_THE_END, AFTER_A_STEP, "keep begins fire implies previously spray"],
    "keep fire directly after spray": [AFTER_THE_END, AFTER_A_STEP, "keep begins fire implies previously spray"],
    "avoid time_holding(fire) > 9 s unless spray or boss_dead": [
        "avoid time_holding(fire) > 9 s and not (spray or boss_dead)",
        "avoid time_holding(fire and not (spray or boss_dead)) > 9 s",
    ],
    "avoid time_holding(fire) > 9 s unless spray": [
        "avoid time_holding(fire) > 9 s and not spray",
        "avoid time_holding(fire and not spray) > 9 s",
    ],
    "keep time_holding(fire) <= 9 s unless spray": [
        "keep time_holding(fire) <= 9 s or spray",
        "keep time_holding(fire and not spray) <= 9 s",
    ],
    "no fire for more than 9 s unless spray": [
        "avoid time_holding(fire) > 9 s and not spray",
        "avoid time_holding(fire and not spray) > 9 s",
    ],
    "fire for at most 9 s unless spray": [
        "avoid time_holding(fire) > 9 s and not spray",
        "avoid time_holding(fire and not spray) > 9 s",
    ],
    "avoid fire then within 3 s spray unless boss_dead": [
        "avoid fire then within 3 s (spray and not boss_dead)",
        "avoid (fire and not boss_dead) then within 3 s spray",
    ],
    "keep fire and spray unless boss_dead": [
        "keep (fire and spray) or boss_dead",
        "keep fire and (spray or boss_dead)",
    ],
}
"""Sentences with several readings, which the help names."""


@pytest.mark.parametrize("typed", FIXED)
def test_a_sentence_with_one_reading_gets_its_clauses(typed: str) -> None:
    text, left = fix(spec(typed).text)
    assert not left
    assert [line.strip() for line in text.splitlines()[-len(FIXED[typed]) - 1 : -1]] == FIXED[typed]


@pytest.mark.parametrize("typed", NAMED)
def test_a_sentence_with_several_readings_gets_them_in_its_help(typed: str) -> None:
    (error,) = errors(spec(typed))
    assert not error.fixes
    readings = read(typed).readings
    assert [reading.clauses for reading in readings] == [(clause,) for clause in NAMED[typed]]
    for clause in NAMED[typed]:
        assert is_valid((clause,))
        assert f"`{clause}`" in (error.help or "")


@pytest.mark.parametrize("typed", [
    "avoid shift again before phase is menu",
    "avoid phase is shift again before phase is menu",
])  # fmt: skip
def test_a_value_that_comes_again_is_not_forbidden_at_first(typed: str) -> None:
    (error,) = errors(spec(typed))
    assert all(f"`{clause}`" in (error.help or "") for clause in AGAIN)


@pytest.mark.parametrize("typed", [
    "avoid fire except for the first 3 laps",
    "when spray, fire right after",
    "never fire right after spray within 3 s",
    "after spray, fire, otherwise boss_dead",
    "fire changes only when spray",
    "fire flips when spray",
])  # fmt: skip
def test_no_form_leaves_out_an_exception_or_that_something_comes_directly_after(typed: str) -> None:
    (error,) = errors(spec(typed))
    assert "write one of these" not in (error.help or "")
    assert not error.fixes


def test_a_count_since_its_own_event_beside_another_condition_gets_no_clause() -> None:
    assert read("fire only when at least 2 spray since the last fire and boss_dead").readings == ()


def test_a_rule_of_several_that_is_not_understood_is_named() -> None:
    (error,) = errors(spec("avoid fire, keep hatch closed while spray, and avoid coins > 3"))
    assert error.help == (
        "write each rule on a line of its own: `avoid fire` and `avoid coins > 3`; "
        "`keep hatch closed while spray` is not understood"
    )


@pytest.mark.parametrize(
    ("clause", "same"),
    [
        # The first 0.3 s of spray are three steps.
        (
            "avoid fire and time_holding(spray) >= 0.3 s",
            "avoid fire and spray and previously (spray and previously (spray and previously spray))",
        ),
        (
            "avoid fire and spray and time_holding(spray) < 0.2 s",
            "avoid fire and spray and not previously (spray and previously spray)",
        ),
        # Three steps last 0.3 s.
        (
            "keep ends fire and time_since(begins fire) >= 0.3 s implies spray",
            "keep ends fire and previously (fire and previously (fire and previously fire)) implies spray",
        ),
        (
            "avoid fire and spray and time_since(begins spray) >= 0.2 s",
            "avoid fire and spray and previously (spray and previously spray)",
        ),
        ("avoid previously (phase is menu) and phase is shift", "avoid ends (phase is menu) and phase is shift"),
        (
            "require weak_next after 0.3 s always not fire",
            "keep fire implies not previously previously previously true",
        ),
    ],
)
def test_the_time_of_an_exception_ends_at_the_right_step(clause: str, same: str) -> None:
    assert is_equivalent(*(f"{HEAD}spec s {{\n{text}\n}}\n" for text in (clause, same)))


OTHERS = {"spray": False, "boss_dead": False, "coins": 0, "lap": 0, "health": 1, "phase": 0, "state": 0}


def verdicts(clause: str, steps: list[dict[str, bool]]) -> list[bool]:
    (fspa,) = tltlc.compile_text(f"{HEAD}spec s {{ {clause} }}")
    monitor = Monitor(fspa)
    return [monitor.step({**OTHERS, "fire": False, **step}).verdict == "violated" for step in steps]


def test_both_the_beginnings_and_the_ends_of_a_bool_are_changes() -> None:
    steps = [{"fire": fire} for fire in (False, True, False, True, True, False, True)]
    clause = "keep times(begins fire, 5) + times(ends fire, 5) <= 4"
    assert verdicts(clause, steps) == [False, False, False, False, False, False, True]


def test_a_count_at_an_event_is_that_of_the_steps_before_it() -> None:
    clause = "keep begins fire implies previously (times_since(spray, fire) >= 2)"
    spray, rest, fire, both = {"spray": True}, {"spray": False}, {"fire": True}, {"fire": True, "spray": True}
    enough = [spray, rest, spray, rest, fire, fire, rest, spray, rest, spray, rest, both]
    assert not any(verdicts(clause, enough))
    assert not any(verdicts(clause, [*enough, rest, spray, rest, fire]))  # the step of an event begins its count
    assert verdicts(clause, [*enough, rest, fire])[-1]
