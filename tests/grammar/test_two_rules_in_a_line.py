"""Two rules in a line, rules with two cases, and the time between two events get the clauses that they mean."""

from __future__ import annotations

import pytest

import tltlc
from tests.grammar.phrases_as_typed import errors, fix
from tests.grammar.sentences import HEAD, read
from tests.grammar.test_windows_in_sentences import is_kept
from tltlc.core.source import SourceFile

SAME_HEALTH = "(health >= previous(health) and health <= previous(health))"
ONE_READING = {
    # An exception with what has happened before.
    "avoid fire while phase is shift unless spray and once boss_dead": [
        "keep fire and phase is shift implies spray and once boss_dead"
    ],
    "avoid fire while spray unless coins >= 3 or once boss_dead": [
        "keep fire and spray implies coins >= 3 or once boss_dead"
    ],
    # A rule with a condition before a rule with a time.
    "keep fire while spray and no boss_dead for more than 5 s": [
        "keep spray implies fire",
        "avoid time_holding(boss_dead) > 5 s",
    ],
    # Two cases.
    "keep coins == previous(coins) + 1 if ends fire, otherwise coins == previous(coins)": [
        "keep ends fire implies coins == previous(coins) + 1",
        "keep not ends fire implies coins == previous(coins)",
    ],
    "if fire starts, coins increases by 1, otherwise coins stays the same": [
        "keep begins fire implies coins == previous(coins) + 1",
        "keep not begins fire implies coins == previous(coins)",
    ],
    "keep coins == 1 if fire, else coins == 2": ["keep fire implies coins == 1", "keep not fire implies coins == 2"],
    # One of two.
    "at the end either fire or spray but not both": ["require eventually always (fire iff not spray)"],
    "keep fire or spray, but not both": ["keep fire iff not spray"],
    "if boss_dead then either fire or spray and not both": ["keep boss_dead implies (fire iff not spray)"],
    # The time between two events.
    "at least 3 s between ends fire and begins fire": ["keep ends fire implies always for 3 s not (begins fire)"],
    "at least 3 s between begins fire and ends fire": ["keep begins fire implies always for 3 s fire"],
    "at least 5 s between two begins fire": ["avoid (begins fire) then within 5 s (begins fire)"],
    "at least 5 s between each begins fire": ["avoid (begins fire) then within 5 s (begins fire)"],
}
SEVERAL_READINGS = {
    "avoid fire and spray for more than 5 s and keep coins >= 10 as long as phase is shift": [
        "avoid time_holding(fire and spray) > 5 s keep phase is shift implies coins >= 10",
        "avoid time_holding(fire and spray and phase is shift) > 5 s keep phase is shift implies coins >= 10",
    ],
    "fire for at most 5 s, and keep spray if boss_dead": [
        "avoid time_holding(fire) > 5 s keep boss_dead implies spray",
        "avoid time_holding(fire and boss_dead) > 5 s keep boss_dead implies spray",
    ],
    "keep begins fire implies spray or next spray unless health <= 0": [
        "keep begins fire implies spray or next spray or health <= 0",
        "keep begins fire implies spray or health <= 0 or next (spray or health <= 0)",
    ],
    "health stays the same until fire": [
        f"require {SAME_HEALTH} weak_until fire",
        f"require {SAME_HEALTH} until fire",
    ],
    "at least 3 s between ends fire and begins spray": [
        "keep ends fire implies always for 3 s not (begins spray)",
        "keep ends fire implies always for 3 s not (begins spray) "
        "keep begins spray implies always for 3 s not (ends fire)",
    ],
    "if fire starts, spray, otherwise boss_dead": [
        "keep fire implies spray keep not fire implies boss_dead",
        "keep begins fire implies spray keep not begins fire implies boss_dead",
    ],
    "at least 3 s between fire and spray": [
        "keep begins fire implies always for 3 s not (begins spray)",
        "keep ends fire implies always for 3 s not (begins spray)",
        "keep begins fire implies always for 3 s not (begins spray) "
        "keep begins spray implies always for 3 s not (begins fire)",
    ],
}
UNCLEAR = [
    "at least 3 s between begins fire",
    "at least 3 s between fire and spray or boss_dead",
    "fire for at least 5 s and keep spray if boss_dead",
    "avoid fire for more than 5 s and keep spray after boss_dead",
]


@pytest.mark.parametrize("typed", ONE_READING)
def test_a_line_has_the_reading(typed: str) -> None:
    (reading,) = read(typed).readings
    assert (list(reading.clauses), reading.condition) == (ONE_READING[typed], "")
    tltlc.compile_text(f"{HEAD}spec s {{\n{chr(10).join(reading.clauses)}\n}}\n")


@pytest.mark.parametrize("typed", SEVERAL_READINGS)
def test_a_line_has_several_readings(typed: str) -> None:
    readings = read(typed).readings
    assert [" ".join(reading.clauses) for reading in readings] == SEVERAL_READINGS[typed]
    assert all(reading.condition for reading in readings)
    for reading in readings:
        tltlc.compile_text(f"{HEAD}spec s {{\n{chr(10).join(reading.clauses)}\n}}\n")


@pytest.mark.parametrize("typed", UNCLEAR)
def test_a_line_that_may_mean_more_has_no_reading(typed: str) -> None:
    assert not read(typed).readings


@pytest.mark.parametrize("gap", range(5))
def test_the_time_between_two_events_may_be_just_so_long(gap: int) -> None:
    never, once = [False] * 8, [step == 2 + gap for step in range(8)]
    fire = [step < 2 for step in range(8)]  # it ends at step 2
    assert is_kept("at least 0.3 s between ends fire and begins spray", 0, fire, once) == (gap >= 3)
    again = [fires or comes for fires, comes in zip(fire, once, strict=True)]
    assert is_kept("at least 0.3 s between ends fire and begins fire", 0, again, never) == (gap >= 3 or gap == 0)
    before = [step == 7 - gap for step in range(8)]
    late = [step < 7 for step in range(8)]
    either = "at least 0.3 s between ends fire and begins spray"
    assert is_kept(either, 0, late, before) == (gap > 0)
    assert is_kept(either, 1, late, before) == (gap >= 3)


def helps(*typed: str) -> list[str | None]:
    lines = "\n".join(typed)
    return [error.help for error in errors(SourceFile("a.tltl", f"{HEAD}spec s {{\n{lines}\n}}\n"))]


@pytest.mark.parametrize(
    ("typed", "condition"),
    [
        ("require coins does not change until fire", "coins == previous(coins)"),
        ("require health does not change until fire", SAME_HEALTH),
        ("require spray stays true until fire", "spray"),
    ],
)
def test_a_sentence_behind_require_is_read(typed: str, condition: str) -> None:
    (text,) = helps(typed)
    assert text == (
        f"write `require {condition} weak_until fire` if play may end before `fire`, "
        f"or `require {condition} until fire` if `fire` must come"
    )


@pytest.mark.parametrize("state", ["coins > 5", "phase is shift", "not fire", "once fire"])
def test_never_gets_the_whole_clause_beside_another_error(state: str) -> None:
    first, other = helps(f"never {state}", "keep fire or or spray")
    assert first == f"write `avoid {state}`"
    assert other != first


def test_two_rules_become_two_lines() -> None:
    typed = "keep fire while spray and no boss_dead for more than 5 s"
    text, left = fix(f"{HEAD}spec s {{\n  {typed}\n}}\n")
    assert text.endswith("{\n  keep spray implies fire\n  avoid time_holding(boss_dead) > 5 s\n}\n")
    assert not left
