"""Sentences without a reading, what helps say of the clauses of others, and the grammar of sentences itself."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import tltlc
from tests.grammar.phrases_as_typed import errors, fix, is_equivalent
from tests.grammar.sentences import HEAD, read, spec
from tltlc.grammar.english.phrases import PHRASES
from tltlc.grammar.english.readings import Meanings, Sentence
from tltlc.monitor import Monitor

NO_READING = (
    "avoid (fire unless spray)",  # an exception from what is forbidden is no `or`
    "never fire after spray unless boss_dead",  # once spray has been, or from its step on
    "never fire or spray when boss_dead unless coins > 3",
    "fire before spray unless boss_dead",
    "when fire, spray within 5 s and then stays stopped until boss_dead",  # which value means that it is stopped?
    "health never more than 20 above its highest",  # which it never is
    "never fire or spray",
    "reach not fire within 5 s",
    "fire upside down spray",
    "avoid",
    "avoid fire at most 3 times",
    "avoid coins increases by less than 3",
    "when coins increases by at most 3 then fire",
    "keep coins decreases",
    "reach fire for at most 3 s",
    "when fire then spray at most 3 s",
    "reach fire when coins at least 3",
    "fire leads to spray",
    "when fire, spray within 3 s and stays at menu",
    "when fire, coins must be 3 or better",
    "avoid fire and spray at some point",
    "whenever fire, coins must be greater than at the start of my last phase",
)

UNSAYABLE = {
    "fire only after at least 9 steps with spray": "steps in a row once",
    "at some point health is 30 higher than 70 s ago": "no clause can say what `health` was 70 s ago",
    "health never falls by more than 5 in 70 s": "no clause says by how much `health` changes in 70 s",
    "if spray then times(fire) <= 3 within 5 s": "`times(fire) <= 3` counts from the first step on",
    "at least 2 fire in any 5 s": "no short clause says that it is so often in each of them",
    "fire => coins@2s > coins": "no clause can say what `coins` is 2 s later or earlier",
}


@pytest.mark.parametrize("typed", NO_READING)
def test_a_sentence_that_may_mean_anything_has_no_reading(typed: str) -> None:
    assert read(typed) == Sentence()


@pytest.mark.parametrize("typed", UNSAYABLE)
def test_what_no_clause_can_say_is_told(typed: str) -> None:
    found = read(typed)
    assert found.readings == ()
    assert UNSAYABLE[typed] in found.limit
    assert any(UNSAYABLE[typed] in (error.help or "") for error in errors(spec(typed)))


@pytest.mark.parametrize(
    ("typed", "meant"),
    [
        (
            "keep phase == results -> prev(phase) == shift or prev(phase) == results",
            "keep phase is results implies previously (phase is shift) or previously (phase is results)",
        ),
        ("avoid phase == menu and phase == shift", "avoid phase is menu and phase is shift"),
        ("keep times(rise(fire)) <= 2", "keep times(fire) <= 2"),
    ],
)
def test_one_fix_mends_all_words_of_a_clause_that_can_be_parsed(typed: str, meant: str) -> None:
    (error,) = errors(spec(typed))
    assert error.help == f"write `{meant}`"
    text, left = fix(spec(typed).text)
    assert not left
    assert meant in text


@pytest.mark.parametrize(
    ("typed", "note"),
    [
        (
            "fire at most 3 times since spray",
            "`times_since(fire, spray)` counts how often `fire` begins, anew from each step with `spray` on",
        ),
        (
            "when fire for 8 s, eventually spray",
            "each step with `time_holding(fire) >= 8 s` asks anew; write `begins (time_holding(fire) >= 8 s)` if once "
            "is enough\n`time_holding(fire) >= 8 s` needs 81 steps in a row, and its time is 0 s at the first of them; "
            "`time_holding(fire) >= 7.9 s` needs 80",
        ),
        (
            "fire for at most 9 s in total",
            "`total_time(fire)` adds up the lengths of all steps with `fire`",
        ),
        (
            "when fire, coins > coins when spray began",
            "`value_at(coins, begins spray)` is the value at the first step until the first step with `begins spray`",
        ),
        ("fire at most 3 times", "`times(fire)` counts how often `fire` begins: steps in a row count once"),
        (
            "avoid fire and spray for more than 0.3 s",
            "`time_holding(fire and spray) > 0.3 s` needs 5 steps in a row, and its time is 0 s at the first of them; "
            "`time_holding(fire and spray) > 0.2 s` needs 4",
        ),
        ("!fire U spray", "write `weak_until` for `until` if play may end before `spray`"),
        ("when fire, spray on the next step", "write `weak_next` for `next` if play may end at a step with `fire`"),
        ("when fire then X G spray", "write `weak_next` for `next` if play may end at a step with `fire`"),
    ],
)
def test_a_help_says_what_its_clauses_count(typed: str, note: str) -> None:
    (error,) = errors(spec(typed))
    assert error.fixes
    assert (error.help or "").endswith(f"\n{note}")


def test_a_help_about_more_than_the_next_step_says_nothing_of_the_end() -> None:
    (error,) = errors(spec("when fire, next eventually spray"))
    assert error.help == "write `keep fire implies (next eventually spray)`"


@pytest.mark.parametrize(
    ("clauses", "other", "is_same"),
    [
        # At least every so often: the same, but for the end of play.
        ("keep time_holding(not fire) < 0.5 s", "keep eventually within 0.5 s fire", False),
        ("keep (time_holding(not fire) < 0.5 s) or fire", "keep time_holding(not fire) < 0.5 s", True),
        (
            "avoid always for 5 steps not fire and next after 5 steps not fire",
            "keep time_holding(not fire) < 0.5 s",
            True,
        ),
        # From one event to the next: in the past, and in the future.
        (
            "avoid fire and not spray and previously (not spray since (fire and not spray and previously once spray))",
            "keep spray implies weak_next ((not fire and not spray) weak_until (spray or fire and weak_next "
            "(not fire weak_until spray)))",
            True,
        ),
        (
            "keep spray and previously once spray implies "
            "previously (not spray since (fire and not spray and previously once spray))",
            "keep spray implies weak_next (not spray weak_until (fire and not spray))",
            True,
        ),
        (
            "avoid fire and not spray and previously once spray",
            "keep spray implies weak_next (not fire weak_until spray)",
            True,
        ),
    ],
)
def test_two_ways_to_say_a_rule_about_a_stretch_of_play_agree(clauses: str, other: str, is_same: bool) -> None:
    texts = [f"{HEAD}spec s {{\n{text}\n}}\n" for text in (clauses, other)]
    assert is_equivalent(*texts) is is_same


def test_so_many_steps_in_a_row_take_the_time_that_a_note_says() -> None:
    (fspa,) = tltlc.compile_text(f"{HEAD}spec s {{ avoid time_holding(fire) > 0.3 s }}")
    monitor = Monitor(fspa)
    names = {"spray": False, "boss_dead": False, "coins": 0, "lap": 0, "health": 1, "phase": 0, "state": 0}
    verdicts = [monitor.step({"fire": True, **names}).verdict for _ in range(5)]
    assert [verdict == "violated" for verdict in verdicts] == [False, False, False, False, True]


@pytest.mark.parametrize("typed", ["keep changes(phase) implies fire", "keep fierce and phase is menu"])
def test_a_name_that_nothing_declares_gets_no_fix_that_leaves_it(typed: str) -> None:
    (error,) = errors(spec(typed))
    assert error.code == "TLT0201"
    assert not (error.help or "").startswith("write ")


def test_an_error_whose_own_fix_is_enough_keeps_it() -> None:
    (error,) = errors(spec("keep phase == results"))
    assert error.help == "write `keep phase is results`"


def test_no_sentence_is_read_without_lark(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tltlc.grammar.english.readings.sentence_parser", lambda: None)
    assert read("when fire then spray") == Sentence()


def grammar() -> str:
    text = (Path(tltlc.__file__).parent / "grammar" / "english" / "sentences.lark").read_text(encoding="utf-8")
    return re.sub("//.*", "", text)


def test_each_list_of_phrases_stands_in_the_grammar() -> None:
    assert set(re.findall(r"\b_w_(\w+)", grammar())) == set(PHRASES)


def test_each_rule_of_the_grammar_has_a_method_that_says_what_it_means() -> None:
    names = re.findall(r"-> *(\w+)", grammar())
    assert len(names) > 100
    assert [name for name in names if not callable(getattr(Meanings, name, None))] == []
