"""Sentences about the first seconds, and about all that happens in a window of time, which the game must record."""

from __future__ import annotations

import pytest

import tltlc
from tests.grammar.phrases_as_typed import errors
from tests.grammar.sentences import HEAD, read
from tltlc.core.source import SourceFile


@pytest.mark.parametrize(
    ("typed", "clause"),
    [
        ("for the first 30 s: no fire, no spray and health > 50",
         "require always for 30 s (not fire and not spray and health > 50)"),
        ("in the first 5 s no phase is menu, no fire", "require always for 5 s (phase is not menu and not fire)"),
        ("for the first 5 s keep health > 50 and avoid fire", "require always for 5 s (health > 50 and not fire)"),
    ],
)  # fmt: skip
def test_several_rules_for_the_first_seconds_are_for_all_of_them(typed: str, clause: str) -> None:
    readings = read(typed).readings
    assert readings[0].clauses == (clause,)
    tltlc.compile_text(f"{HEAD}spec s {{ {clause} }}")


def test_a_time_of_the_first_rule_may_be_for_all_or_for_the_first_alone() -> None:
    readings = read("for the first 5 s: no fire and no spray").readings
    assert [(*reading.clauses, reading.condition) for reading in readings] == [
        ("require always for 5 s (not fire and not spray)", "if it is for all of them"),
        ("require always for 5 s not fire", "avoid spray", "if that time is for the first of them alone"),
    ]


@pytest.mark.parametrize(
    ("typed", "signal"),
    [
        ("keep fire for at most 10 s in any 90 s", "fire_time: time in [0 s, 60 s]"),
        ("the average of health over 60 s is at most 5", "health_mean in [0, 100]"),
        ("the mean health over the last 60 s must be below 50", "health_mean in [0, 100]"),
        ("health changes by at most 5 in any 90 s", "health_change in [-100, 100]"),
        ("while fire, health rises by at least 20 every 15 s", "recent_change in [-100, 100]"),
    ],
)
def test_what_needs_all_values_of_a_window_is_for_the_game_to_record(typed: str, signal: str) -> None:
    result = read(typed)
    assert result.readings == ()
    assert f"`signal {signal}`" in result.limit
    number = f"{signal.split()[0].rstrip(':')} <= 10{' s' * (': time' in signal)}"
    tltlc.compile_text(f"clock 10 Hz\nsignal {signal}\nspec s {{ keep {number} }}")


@pytest.mark.parametrize(
    ("typed", "clause"),
    [
        ("health changes by at most 5 per step", "keep abs(health - previous(health)) <= 5"),
        (
            "health changes by at most 5 in any 3 s",
            "keep highest_within(health, 3 s) - lowest_within(health, 3 s) <= 5",
        ),
        ("health never falls by more than 5 in 30 s", "keep health >= highest_within(health, 30 s) - 5"),
        ("keep fire for at most 10 s in any 60 s", "keep total_time_within(fire, 60 s) <= 10 s"),
        ("never fire for more than 10 s in total in any 60 s", "keep total_time_within(fire, 60 s) <= 10 s"),
        ("at most 10 s of fire within any 60 s", "keep total_time_within(fire, 60 s) <= 10 s"),
        ("at most 3 fire in any 5 s", "keep times_within(fire, 5 s) <= 3"),
    ],
)
def test_what_one_step_or_a_count_can_say_has_a_reading(typed: str, clause: str) -> None:
    (reading,) = read(typed).readings
    assert reading.clauses == (clause,)


@pytest.mark.parametrize(
    ("typed", "clause"),
    [
        ("after spray, fire at most 3 times within 5 s",
         "keep once within 5 s begins spray implies times_since(fire, begins spray) <= 3"),
        ("at most 3 fire within 5 s after spray",
         "keep once within 5 s begins spray implies times_since(fire, begins spray) <= 3"),
        ("after spray at least 2 fire within 5 s",
         "keep begins spray implies eventually within 5 s times_since(fire, begins spray) >= 2"),
        ("spray only if times(fire) >= 3 within 5 s", "keep spray implies times_within(fire, 5 s) >= 3"),
        ("when times(fire) >= 3 within 5 s then spray", "keep times_within(fire, 5 s) >= 3 implies spray"),
    ],
)  # fmt: skip
def test_a_count_within_a_time_begins_where_the_sentence_says(typed: str, clause: str) -> None:
    (reading,) = read(typed).readings
    assert reading.clauses == (clause,)
    (error,) = errors(SourceFile("a.tltl", f"{HEAD}spec s {{\n{typed}\n}}\n"))
    assert (error.help or "").startswith(f"write `{clause}`")


def test_a_time_without_something_is_the_condition_of_its_rule() -> None:
    typed = "without fire for at least 8 s, spray within 2 s"
    (error,) = errors(SourceFile("a.tltl", f"{HEAD}spec s {{\n{typed}\n}}\n"))
    assert "`keep begins (time_holding(not fire) >= 8 s) implies eventually within 2 s spray`" in (error.help or "")
    assert "require" not in (error.help or "")


@pytest.mark.parametrize(
    ("typed", "clause"),
    [
        ("reach at least 3 fire within 5 s", "reach times_within(fire, 5 s) >= 3"),
        ("reach at least 3 fire before spray", "require not spray until times(fire) >= 3"),
    ],
)
def test_a_goal_that_counts_keeps_its_readings(typed: str, clause: str) -> None:
    (error,) = errors(SourceFile("a.tltl", f"{HEAD}spec s {{\n{typed}\n}}\n"))
    assert f"`{clause}`" in (error.help or "")
    assert error.fixes == ()


@pytest.mark.parametrize(
    "typed",
    ["keep begins fire implies spray within less than 2 s", "whenever fire begins, spray in under 2 s"],
)
def test_less_than_a_time_is_told_that_its_last_step_counts(typed: str) -> None:
    (error,) = errors(SourceFile("a.tltl", f"{HEAD}spec s {{\n{typed}\n}}\n"))
    assert (error.help or "").startswith("write `keep begins fire implies eventually within 2 s spray`")
    assert "2 s later counts, too: write 1.9 s if that is too late" in (error.help or "")
