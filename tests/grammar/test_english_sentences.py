"""Sentences of designers mean the clauses that the grammar of sentences reads from them."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import tltlc
from tests.grammar.phrases_as_typed import errors, fix
from tltlc.core.source import SourceFile
from tltlc.grammar.english.phrases import PHRASES
from tltlc.grammar.english.readings import Sentence, sentence
from tltlc.grammar.english.rules import Rules
from tltlc.grammar.lexer import tokenize
from tltlc.grammar.mistakes.declared_names import declared_names
from tltlc.grammar.mistakes.sentences.calls import with_own_calls
from tltlc.grammar.mistakes.sentences.validity import is_valid
from tltlc.grammar.mistakes.sentences.vocabulary import ENGLISH
from tltlc.grammar.mistakes.sentences.words import words_of
from tltlc.monitor import Monitor

HEAD = """\
clock 10 Hz
signal fire: bool
signal spray: bool
signal boss_dead: bool
signal coins: int in [0, 99]
signal health in [0, 100]
signal phase: (menu, shift, results)
signal state: (Idle, Dead)
"""

ONE_READING = {
    "when phase becomes results and coins >= 30 then health < 3": [
        "keep begins (phase is results) and coins >= 30 implies health < 3"
    ],
    "avoid fire and not spray for more than 3 s": ["avoid time_holding(fire and not spray) > 3 s"],
    "avoid fire for more than 5 steps": ["avoid always for 5 steps fire and next after 5 steps fire"],
    "whenever health falls below 20 then spray within 2 s": ["keep within 2 s of begins (health < 20), spray"],
    "when health falls below 20, spray": ["keep health < 20 implies spray"],
    "fire starts only if spray for at least 5 s": ["keep begins fire implies time_holding(spray) >= 5 s"],
    "fire only after spray for 3 s": ["keep begins fire implies time_holding(spray) >= 3 s"],
    "avoid fire unless spray since last fire": ["keep fire implies previously (not fire since spray)"],
    "while fire keep health unchanged": ["keep fire implies health >= previous(health) and health <= previous(health)"],
    "keep health never decreases unless fire": ["keep health >= previous(health) or fire"],
    "whenever fire then spray or boss_dead within 5 s unless phase is menu": [
        "keep within 5 s of fire, spray or boss_dead or phase is menu"
    ],
    "whenever fire starts keep fire for exactly 4 steps": [
        "keep begins fire implies (always for 4 steps fire) and weak_next after 4 steps not fire"
    ],
    "keep spray implies fire within 3 s before": ["keep spray implies once within 3 s fire"],
    "phase changes only when fire": [
        "keep ends (phase is menu) or ends (phase is shift) or ends (phase is results) implies fire"
    ],
    "when fire, coins > coins at start": ["keep fire implies coins > initial(coins)"],
    "whenever fire && spray, boss_dead within 2 frames unless state == Dead": [
        "keep within 2 steps of fire and spray, boss_dead or state is Dead"
    ],
    "avoid state becomes Dead unless prev(state) == Idle": [
        "keep begins (state is Dead) implies previously (state is Idle)"
    ],
    "reach any of fire, not spray within 3 s": ["require eventually within 3 s (fire or not spray)"],
    "avoid any of fire, spray, boss_dead": ["avoid (fire or spray or boss_dead)"],
    "keep exactly one of fire, spray": ["keep (fire and not spray) or (not fire and spray)"],
    "keep at most one of fire, spray": ["keep not (fire and spray)"],
    "keep none of fire and spray": ["keep (not fire and not spray)"],
    "when health falls below 20 then fire starts": ["keep begins (health < 20) implies begins fire"],
    "when health falls below 20 then fire on the next step": ["keep begins (health < 20) implies weak_next fire"],
    "when health falls below 20 then fire until spray": ["keep begins (health < 20) implies (fire until spray)"],
    "keep coins increases by at most 3": ["keep coins <= previous(coins) + 3"],
    "when phase becomes menu or shift then fire": [
        "keep begins (phase is menu) or begins (phase is shift) implies fire"
    ],
    "keep phase is not menu or shift": ["keep not (phase is menu or phase is shift)"],
    "when fire then spray turns off": ["keep fire implies not spray"],
    "when fire then spray starts for 3 s": ["keep fire implies always for 3 s spray"],
    "when fire then spray for exactly 3 steps": [
        "keep begins fire implies (always for 3 steps spray) and weak_next after 3 steps not spray"
    ],
    "fire only if spray since fire": ["keep fire implies previously (not fire since spray)"],
    "when fire then no spray within 3 s": ["keep fire implies not eventually within 3 s spray"],
    "if fire then spray": ["keep fire implies spray"],
    "reach (fire then spray) 2 times": ["reach fire then spray then fire then spray"],
    "phase leaves shift only if coins > 3": ["keep ends (phase is shift) implies coins > 3"],
    "keep 9 <= coins < 17": ["keep 9 <= coins and coins < 17"],
    "when fire ends\nthen spray": ["keep ends fire implies spray"],
    "when fire then not spray\nwhen spray then health == 5": [
        "keep fire implies not spray",
        "keep spray implies health >= 5 and health <= 5",
    ],
    "keep spray -> Y((!fire) S boss_dead)": ["keep spray implies previously (not fire since boss_dead)"],
}

SEVERAL_READINGS = {
    "fire only if spray since boss_dead": [
        ("keep fire implies (spray since boss_dead)", ""),
        ("keep fire implies (not boss_dead since spray)", ""),
    ],
    "whenever fire becomes false then not spray within 5 s": [
        ("keep ends fire implies not eventually within 5 s spray", "if it must hold at no step of that time"),
        ("keep within 5 s of ends fire, not spray", "if one step is enough"),
    ],
    "once fire keep fire until spray": [
        ("keep fire implies (fire until spray)", "if `spray` must come"),
        ("keep fire implies (fire weak_until spray)", "if it need not"),
    ],
    "fire while spray": [
        ("reach fire and spray", "if it is a goal"),
        ("keep spray implies fire", "for each step with `spray`"),
    ],
    "when fire avoid spray": [
        ("avoid fire and spray", "for each step with `fire`"),
        ("keep fire implies always not spray", "if it holds from then on"),
    ],
}

NO_READING = (
    "never fire or spray",
    "if fire then spray until boss_dead",
    "keep fire or spray unless boss_dead and fire",
    "reach not fire within 5 s",
    "fire upside down spray",
    "avoid",
    "avoid fire at most 3 times",
    "avoid coins increases by less than 3",
    "when coins increases by at most 3 then fire",
    "keep coins decreases",
    "reach fire for at most 3 s",
    "when fire then spray at most 3 s",
    "each spray lasts exactly 3 s",
    "reach fire when coins at least 3",
)

UNSAYABLE = {
    "when fire then coins == coins at last spray": "no clause can say what `coins` was at `spray`",
    "when fire ends then coins >= (coins when fire started) + 5": "no clause can say what `coins` was at `fire`",
    "when fire then coins > coins when phase became shift": "what `coins` was at `phase becomes shift`",
    "avoid more than 2 times fire within 5 s": "no clause can say how often",
    "fire for at most 4 s in total": "no clause can say for how long `fire` holds in total",
}


def read(typed: str) -> Sentence:
    source = SourceFile("a.tltl", f"{HEAD}spec s {{\n{typed}\n}}\n")
    start = len(HEAD) + len("spec s {\n")
    tokens = [token for token in tokenize(source.text).tokens if start <= token.start < token.end <= start + len(typed)]
    return sentence(with_own_calls(words_of(source, declared_names(source), tokens, ENGLISH)))


@pytest.mark.parametrize("typed", ONE_READING)
def test_a_sentence_has_the_reading(typed: str) -> None:
    (reading,) = read(typed).readings
    assert list(reading.clauses) == ONE_READING[typed]
    tltlc.compile_text(f"{HEAD}spec s {{\n{chr(10).join(reading.clauses)}\n}}\n")


@pytest.mark.parametrize("typed", SEVERAL_READINGS)
def test_a_sentence_has_several_readings(typed: str) -> None:
    readings = read(typed).readings
    assert [(*reading.clauses, reading.condition) for reading in readings] == SEVERAL_READINGS[typed]
    assert all(is_valid(reading.clauses) for reading in readings)


@pytest.mark.parametrize("typed", NO_READING)
def test_a_sentence_that_may_mean_anything_has_no_reading(typed: str) -> None:
    assert read(typed) == Sentence()


@pytest.mark.parametrize("typed", UNSAYABLE)
def test_what_no_clause_can_say_is_told(typed: str) -> None:
    found = read(typed)
    assert found.readings == ()
    assert UNSAYABLE[typed] in found.limit
    assert any(UNSAYABLE[typed] in (error.help or "") for error in errors(spec(typed)))


def spec(typed: str) -> SourceFile:
    return SourceFile("a.tltl", f"{HEAD}spec s {{\n{typed}\n}}\n")


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
        ("fire at most 3 times", "`times(fire)` counts how often `fire` begins: steps in a row count once"),
        (
            "avoid fire and spray for more than 0.3 s",
            "`time_holding(fire and spray) > 0.3 s` needs 5 steps in a row, and its time is 0 s at the first of them; "
            "`time_holding(fire and spray) > 0.2 s` needs 4",
        ),
        ("when fire then spray until boss_dead", "write `weak_until` for `until` if play may end before `boss_dead`"),
    ],
)
def test_a_help_says_what_its_clauses_count(typed: str, note: str) -> None:
    (error,) = errors(spec(typed))
    assert error.fixes
    assert (error.help or "").endswith(f"; {note}")


def test_so_many_steps_in_a_row_take_the_time_that_a_note_says() -> None:
    (fspa,) = tltlc.compile_text(f"{HEAD}spec s {{ avoid time_holding(fire) > 0.3 s }}")
    monitor = Monitor(fspa)
    names = {"spray": False, "boss_dead": False, "coins": 0, "health": 1, "phase": 0, "state": 0}
    verdicts = [monitor.step({"fire": True, **names}).verdict for _ in range(5)]
    assert [verdict == "violated" for verdict in verdicts] == [False, False, False, False, True]


@pytest.mark.parametrize("typed", ["keep changes(phase) implies fire", "keep fierce and phase is menu"])
def test_a_name_that_nothing_declares_gets_no_fix_that_leaves_it(typed: str) -> None:
    (error,) = errors(spec(typed))
    assert error.code == "TLT0201"
    assert not (error.help or "").startswith("write ")


def test_an_error_whose_own_fix_is_enough_keeps_it() -> None:
    (error,) = errors(spec("keep phase == results"))
    assert error.help == "write `phase is results`"


def test_no_sentence_is_read_without_lark(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tltlc.grammar.english.readings.find_spec", lambda name: None)
    assert read("when fire then spray") == Sentence()


def grammar() -> str:
    text = (Path(tltlc.__file__).parent / "grammar" / "english" / "sentences.lark").read_text(encoding="utf-8")
    return re.sub("//.*", "", text)


def test_each_list_of_phrases_stands_in_the_grammar() -> None:
    assert set(re.findall(r"\b_w_(\w+)", grammar())) == set(PHRASES)


def test_each_rule_of_the_grammar_has_a_method_that_says_what_it_means() -> None:
    names = re.findall(r"-> *(\w+)", grammar())
    assert len(names) > 100
    assert [name for name in names if not callable(getattr(Rules, name, None))] == []
