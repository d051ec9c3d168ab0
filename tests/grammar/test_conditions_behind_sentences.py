"""`unless c` and `while c` behind sentences that the grammar reads without them."""

from __future__ import annotations

import pytest

from tests.grammar.phrases_as_typed import errors
from tests.grammar.sentences import read, spec, words_of_sentence
from tltlc.grammar.english.ends import end_of
from tltlc.grammar.mistakes.sentences.validity import is_valid

LATER = "if steps in a row count once, and `state is Dead` counts at the later of the two"
BOTH = "if steps in a row count once, and both count only while `phase is menu`"

READINGS: dict[str, list[tuple[str, str]]] = {
    "keep fire at least 8 s apart unless state is Dead": [
        ("avoid (begins fire) then within 8 s ((begins fire) and state is not Dead)", LATER),
        (
            "avoid fire then within 8 s (fire and state is not Dead)",
            "if each step counts, and `state is Dead` counts at the later of the two",
        ),
    ],
    "no two fire within 8 s while phase is menu": [
        ("avoid ((begins fire) and phase is menu) then within 8 s ((begins fire) and phase is menu)", BOTH),
        (
            "avoid (fire and phase is menu) then within 8 s (fire and phase is menu)",
            "if each step counts, and both count only while `phase is menu`",
        ),
    ],
    "health never drops more than 20 below its highest unless state is Dead": [
        ("keep health >= highest(health) - 20 or state is Dead", "")
    ],
    "total time fire at most 30 s unless state is Dead": [("keep total_time(fire) <= 30 s or state is Dead", "")],
    "no spray after fire without boss_dead in between while phase is menu": [
        ("avoid spray and previously (not boss_dead since fire) and phase is menu", "")
    ],
    "fire starts only if spray for at least 5 s while phase is menu": [
        ("keep begins fire and phase is menu implies time_holding(spray) >= 5 s", "")
    ],
    "keep begins fire implies spray exactly 3 s later unless boss_dead in that time": [
        (
            "keep ends (once within 29 steps begins fire) implies spray or once within 3 s boss_dead",
            "if it must hold 3 s after the last `begins fire`, at that step",
        ),
    ],
    "after fire, spray within 3 s unless boss_dead within 3 s": [
        (
            "keep fire implies boss_dead or (eventually within 3 s spray)",
            "if `boss_dead` counts only at the first step of that time",
        ),
        ("keep fire implies eventually within 3 s (spray or boss_dead)", "if `boss_dead` in that time is enough"),
    ],
}


@pytest.mark.parametrize("typed", READINGS)
def test_the_clauses_of_a_sentence_get_the_condition_behind_it(typed: str) -> None:
    assert [(*reading.clauses, reading.condition) for reading in read(typed).readings] == READINGS[typed]
    assert all(is_valid(reading.clauses) for reading in read(typed).readings)


@pytest.mark.parametrize("typed", READINGS)
def test_the_help_has_the_clauses(typed: str) -> None:
    (error,) = errors(spec(typed))
    assert all(clause in (error.help or "") for clause, _ in READINGS[typed])


@pytest.mark.parametrize(
    "typed",
    [
        "coins never falls; never fire unless state is Dead",  # of both, or of the last
        "fire for at most 3 steps in total unless state is Dead",
        "phase only goes menu then shift then results while state is Dead",
        "reach fire then spray unless state is Dead",
    ],
)
def test_an_end_that_may_mean_several_things_is_not_read(typed: str) -> None:
    assert read(typed).readings == ()


def test_words_without_an_end_have_none() -> None:
    assert end_of(words_of_sentence("keep fire at least 8 s apart")) is None
