"""Sentences whose answers have several times, stand in brackets or look a time ahead, and changes as arguments."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import pytest

import tltlc
from tests.grammar.phrases_as_typed import errors
from tests.grammar.sentences import HEAD, read, spec
from tltlc.grammar.mistakes.sentences.validity import is_valid
from tltlc.monitor import Monitor


def counted(call: str, most: int) -> str:
    kinds = [f"ends (phase is {value})" for value in ("menu", "shift", "results")]
    return f"({' + '.join(call.format(kind, most) for kind in kinds)})"


ONE_READING = {
    # What stops, and what follows then.
    "when fire, spray stops within 3 s": ["keep fire implies eventually within 3 s not spray"],
    "after coins == 0 begins, spray stops within 3 s and then not spray for 5 s": [
        "keep begins (coins == 0) implies eventually within 3 s not spray",
        "keep not spray and (begins (coins == 0) or ends spray) and once within 3 s begins (coins == 0) implies "
        "always for 5 s not spray",
    ],
    "after fire, spray within 0.5 s and then not boss_dead for 5 s": [
        "keep fire implies eventually within 0.5 s (spray and always for 5 s not boss_dead)"
    ],
    "after fire, spray within 3 s and then not boss_dead for 5 s": [
        "keep fire implies eventually within 3 s spray",
        "keep spray and (fire or begins spray) and once within 3 s fire implies always for 5 s not boss_dead",
    ],
    "when fire, coins > 3 within 3 s for at least 5 s": [
        "keep fire implies eventually within 3 s coins > 3",
        "keep coins > 3 and (fire or begins coins > 3) and once within 3 s fire implies always for 5 s coins > 3",
    ],
    "when coins <= 3 ends, spray": ["keep ends (coins <= 3) implies spray"],
    # Answers that come in a time, and last.
    "keep begins coins <= 0 implies within 3 steps (not spray for 1 s)": [
        "keep begins (coins <= 0) implies eventually within 3 steps always for 1 s not spray"
    ],
    "keep fire implies eventually within 3 steps spray for 1 s": [
        "keep fire implies eventually within 3 steps always for 1 s spray"
    ],
    "when fire, spray within 0.5 s and stays on for 5 s": [
        "keep fire implies eventually within 0.5 s always for 5 s spray"
    ],
    # Answers in brackets.
    "keep begins fire implies (coins rises within 2 steps) or coins == 99": [
        "keep begins fire implies (eventually within 2 steps coins > previous(coins)) or coins == 99"
    ],
    "keep fire implies boss_dead or (spray within 2 s)": [
        "keep fire implies boss_dead or (eventually within 2 s spray)"
    ],
    "keep fire implies (spray within 2 s) and boss_dead": [
        "keep fire implies (eventually within 2 s spray) and boss_dead"
    ],
    # What has held before.
    "keep begins fire implies spray held for at least 1 s just before": [
        "keep begins fire implies previously time_holding(spray) >= 1 s"
    ],
    "fire only if spray held for 1 s just before": ["keep fire implies previously time_holding(spray) >= 1 s"],
    "keep begins fire implies spray held for 1 s just before, with no boss_dead since begins spray": [
        "keep begins fire implies previously time_holding(spray) >= 1 s and (not boss_dead since begins spray)"
    ],
    # A time after an event.
    "0.5 s after ends fire, spray": ["keep ends fire implies next after 0.5 s spray"],
    # Numbers that stay the same, and how far two are apart.
    "keep coins and lap unchanged unless phase is shift": [
        "keep (coins == previous(coins) and lap == previous(lap)) or phase is shift"
    ],
    "keep coins unchanged unless fire and spray": ["keep coins == previous(coins) or (fire and spray)"],
    "keep health unchanged unless fire": ["keep (health >= previous(health) and health <= previous(health)) or fire"],
    "keep the distance between coins and lap <= 12": ["keep abs(coins - lap) <= 12"],
    "difference of coins and lap must be at most 12": ["keep abs(coins - lap) <= 12"],
    "coins and lap must be at most 3 apart": ["keep abs(coins - lap) <= 3"],
    "coins and lap are never more than 3 apart": ["keep abs(coins - lap) <= 3"],
    "the difference between coins and lap is never more than 3": ["keep abs(coins - lap) <= 3"],
    "keep abs(coins - lap) <= abs(coins - lap) 0.1 s ago + 6": [
        "keep abs(coins - lap) <= previous(abs(coins - lap)) + 6"
    ],
    # Changes as arguments.
    "keep times_within(changes phase, 2 s) <= 4": [f"keep {counted('times_within({}, 2 s, {})', 5)} <= 4"],
    "avoid times(phase changes) >= 4": [f"avoid {counted('times({}, {})', 4)} >= 4"],
    "keep times_since(phase changes, lap changes) <= 4": [
        f"keep {counted('times_since({}, lap != previous(lap), {})', 5)} <= 4"
    ],
    "keep times_within(fire changes, 2 s) <= 4": [
        "keep (times_within(ends fire, 2 s, 5) + times_within(ends (not fire), 2 s, 5)) <= 4"
    ],
    "keep times_since(fire, changes lap) <= 3": ["keep times_since(fire, lap != previous(lap)) <= 3"],
    "keep times_since(fire, health changes) <= 3": [
        "keep times_since(fire, health < previous(health) or health > previous(health)) <= 3"
    ],
}
UNTIL = [
    (
        "keep ends fire implies eventually within 1 s (spray and (spray weak_until fire))",
        "if play may end before `fire`",
    ),
    ("keep ends fire implies eventually within 1 s (spray and (spray until fire))", "if `fire` must come"),
]
HELD_WITHIN = [
    (
        "keep fire implies eventually within 3 s spray",
        "keep spray and (fire or begins spray) and once within 3 s fire implies always for 2 s spray",
        "if `spray` begins within 3 s, and then lasts 2 s",
    ),
    (
        "keep fire implies eventually within 3 s time_holding(spray) >= 2 s",
        "if `spray` may have begun before, and has held for 2 s within 3 s",
    ),
]
LASTS = "if `phase is menu` must last at least 0.5 s, and end within 1.5 s"
SEVERAL_READINGS: Mapping[str, Sequence[tuple[str, ...]]] = {
    "when fire ends then spray within 1 s and spray until fire": UNTIL,
    "when fire ends then spray within 1 s and then spray until fire": UNTIL,
    "when fire ends then spray within 1 s and stays on until fire": UNTIL,
    "when fire ends, spray begins within 1 s and it remains on until fire": UNTIL,
    "when fire then spray within 1 s and boss_dead until coins > 3": [
        (
            "keep fire implies eventually within 1 s (spray and (boss_dead weak_until coins > 3))",
            "if `boss_dead` must hold from `spray` on, and play may end before `coins > 3`",
        ),
        (
            "keep fire implies eventually within 1 s (spray and (boss_dead until coins > 3))",
            "if `boss_dead` must hold from `spray` on, and `coins > 3` must come",
        ),
        (
            "keep fire implies (eventually within 1 s spray) and (boss_dead weak_until coins > 3)",
            "if `boss_dead` must hold from the condition on, and play may end before `coins > 3`",
        ),
        (
            "keep fire implies (eventually within 1 s spray) and (boss_dead until coins > 3)",
            "if `boss_dead` must hold from the condition on, and `coins > 3` must come",
        ),
    ],
    "whenever begins fire, next phase is shift for at least 0.5 s": [
        (
            "keep begins fire implies weak_next always for 0.5 s phase is shift",
            "if play may end at the step of the condition",
        ),
        ("keep begins fire implies next always for 0.5 s phase is shift", "if there must be a next step"),
    ],
    "keep fire implies within 3 s (spray for 2 s)": HELD_WITHIN,
    "keep fire implies within 3 s spray for 2 s": HELD_WITHIN,
    "keep fire implies (spray for 1 s)": [
        ("keep fire implies time_holding(spray) >= 1 s", "if it must have lasted until then"),
        ("keep fire implies always for 1 s spray", "if it must last from then on"),
    ],
    "keep fire implies (spray for 1 s) or boss_dead": [
        ("keep fire implies time_holding(spray) >= 1 s or boss_dead", "if it must have lasted until then"),
        ("keep fire implies (always for 1 s spray) or boss_dead", "if it must last from then on"),
    ],
    "when fire ends, coins rises within 2 steps or boss_dead": [
        (
            "keep ends fire implies eventually within 2 steps (coins > previous(coins) or boss_dead)",
            "if the time is for `boss_dead`, too",
        ),
        (
            "keep ends fire implies (eventually within 2 steps coins > previous(coins)) or boss_dead",
            "if the time is for `coins > previous(coins)` alone",
        ),
    ],
    # Between two times.
    "keep begins phase is menu implies phase is not menu between 0.5 s and 1.5 s later, unless fire": [
        (
            "keep begins (phase is menu) implies (always for 0.5 s phase is menu) or (phase is menu until fire)",
            "keep time_holding(phase is menu) < 1.5 s or fire",
            f"{LASTS}, unless `fire` comes first",
        )
    ],
    "when phase becomes menu, phase is not menu between 5 s and 10 s later": [
        (
            "keep begins (phase is menu) implies always for 5 s phase is menu",
            "keep time_holding(phase is menu) < 10 s",
            "if `phase is menu` must last at least 5 s, and end within 10 s",
        )
    ],
    "keep fire implies not spray between 0.5 s and 0.8 s later": [
        (
            "keep fire implies not next after 0.5 s eventually within 0.3 s spray",
            "if it must hold at no step of that time",
        ),
        ("keep fire implies next after 0.5 s eventually within 0.3 s not spray", "if one step is enough"),
    ],
    "keep fire implies spray between 0.5 s and 0.8 s later unless boss_dead": [
        (
            "keep fire implies next after 0.5 s eventually within 0.3 s (spray or boss_dead)",
            "if `boss_dead` at a step of that time is enough",
        ),
        (
            "keep fire implies boss_dead or (next after 0.5 s eventually within 0.3 s spray)",
            "if `boss_dead` counts only at the first step of that time",
        ),
    ],
    "2 s after ends fire, spray": [
        (
            "keep ends (once within 19 steps ends fire) implies spray",
            "if the 2 s count from the last step with `ends fire`",
        )
    ],
    "spray exactly 2 s after fire": [
        ("keep ends (once within 19 steps fire) implies spray", "if the 2 s count from the last step with `fire`")
    ],
    "2 s after ends fire without boss_dead, spray": [
        (
            "keep ends (once within 19 steps ends fire) and (not boss_dead since ends fire) implies spray",
            "if the 2 s count from the last step with `ends fire`",
        )
    ],
}
NO_READING = (
    "keep fire implies not spray between 5 s and 8 s later",  # of which a limit may not say the opposite
    "keep the distance between coins and coins <= 3",
)


@pytest.mark.parametrize("typed", ONE_READING)
def test_a_sentence_has_the_reading(typed: str) -> None:
    (reading,) = read(typed).readings
    assert list(reading.clauses) == ONE_READING[typed]
    tltlc.compile_text(f"{HEAD}spec s {{\n{chr(10).join(reading.clauses)}\n}}\n")


@pytest.mark.parametrize("typed", SEVERAL_READINGS)
def test_a_sentence_has_several_readings(typed: str) -> None:
    readings = read(typed).readings
    assert sorted((*reading.clauses, reading.condition) for reading in readings) == sorted(SEVERAL_READINGS[typed])
    assert all(is_valid(reading.clauses) for reading in readings)


@pytest.mark.parametrize("typed", NO_READING)
def test_a_sentence_has_no_reading(typed: str) -> None:
    assert read(typed).readings == ()
    assert read(typed).limit == ""


def test_a_value_of_a_sum_some_time_ago_cannot_be_said() -> None:
    (error,) = errors(spec("keep abs(coins - lap) <= abs(coins - lap) 90 s ago + 6"))
    assert "no clause can say what `abs(coins - lap)` was 90 s ago" in (error.help or "")
    assert "let the game supply that number as a signal" in (error.help or "")


@pytest.mark.parametrize("typed", ["keep times_within(changes lap, 2 s) <= 4", "keep times(lap changes) <= 4"])
def test_a_help_says_that_changes_of_a_number_at_steps_in_a_row_count_once(typed: str) -> None:
    (error,) = errors(spec(typed))
    assert error.fixes
    assert "`lap != previous(lap)` at steps in a row counts once" in (error.help or "")


def test_no_comma_is_offered_between_a_name_and_its_change() -> None:
    (error,) = errors(spec("keep near(changes speed) implies fire"))
    assert error.title == "the language has no word `changes`"
    assert not error.fixes


@pytest.mark.parametrize(
    ("typed", "meant"),
    [
        ("keep times_since(fire, begins lap) <= 1", "keep times_since(fire, lap != previous(lap)) <= 1"),
        ("keep begins lap implies fire", "keep lap != previous(lap) implies fire"),
        ("keep fire or not ends lap", "keep fire or not (lap != previous(lap))"),
        (
            "keep begins health implies fire",
            "keep (health < previous(health) or health > previous(health)) implies fire",
        ),
    ],
)
def test_the_beginning_of_a_number_is_its_change(typed: str, meant: str) -> None:
    (error,) = errors(spec(typed))
    name = "health" if "health" in typed else "lap"
    assert (error.help or "").startswith(f"write `{meant}` if each new value of `{name}` counts, or compare it, e.g. ")
    assert [edit.text for fix in error.fixes for edit in fix.edits] == [meant]
    tltlc.compile_text(f"{HEAD}spec s {{\n{meant}\n}}\n")


@pytest.mark.parametrize("after", range(1, 7))
def test_a_time_after_an_event_is_that_step_alone(after: int) -> None:
    (fspa,) = tltlc.compile_text(
        "clock 10 Hz\nsignal fire: bool\nsignal spray: bool\n"
        "spec s { keep ends (once within 3 steps fire) implies spray }"
    )
    monitor = Monitor(fspa)
    verdicts = [monitor.step({"fire": step == 2, "spray": step != 2 + after}).verdict for step in range(12)]
    assert ("violated" in verdicts) is (after == 4)


def test_each_change_counts_once_in_a_sum() -> None:
    calls = " + ".join(f"times_within(ends (phase is {value}), 2 s, 3)" for value in ("menu", "shift", "results"))
    (fspa,) = tltlc.compile_text(f"clock 10 Hz\nsignal phase: (menu, shift, results)\nspec s {{ keep ({calls}) <= 2 }}")
    monitor = Monitor(fspa)
    verdicts = [monitor.step({"phase": phase}).verdict for phase in (0, 1, 2, 2, 0)]
    assert [verdict == "violated" for verdict in verdicts] == [False, False, False, False, True]
