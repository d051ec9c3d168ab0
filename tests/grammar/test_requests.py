"""Sentences without a keyword: the names that they spell, what they ask for, and those that get no fix."""

from __future__ import annotations

import pytest

from tests.grammar.phrases_as_typed import errors, fix, is_equivalent, prelude
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic


def spec(clauses: str, declarations: str) -> str:
    return f"{prelude(declarations)}spec s {{\n{clauses}\n}}\n"


def first_error(clause: str, declarations: str) -> Diagnostic:
    return errors(SourceFile("a.tltl", spec(clause, declarations)))[0]


@pytest.mark.parametrize(
    ("declarations", "typed", "meant"),
    [
        # Names in other words.
        ("platformer", "collect the key, then open the door", "reach has_key then door_open"),
        ("platformer", "no deaths", "avoid died"),
        ("platformer", "deathless", "avoid died"),
        ("platformer", "pause at most once", "keep times(paused) <= 1"),
        ("shooter", "never reload", "avoid reloading"),
        ("shooter", "take no hits", "avoid hit"),
        ("shooter", "kill with the shotgun", "reach kill and weapon is shotgun"),
        ("stealth", "never raise the alarm", "avoid alarm"),
        ("stealth", "no alarm, no bodies found", "avoid alarm avoid body_found"),
        ("racing", "never leave the track", "avoid off_track"),
        ("racing", "crash at most twice", "keep times(crashed) <= 2"),
        ("rpg", "complete the quest in 10 minutes", "require eventually within 10 min quest_done"),
        ("rpg", "stay out of combat", "keep not in_combat"),
        ("shooter", "respawn within 5 s of dying", "keep died implies eventually within 5 s respawned"),
        ("rpg", "open the chest at night", "reach chest_open and night"),
        ("puzzle", "never touch the laser", "avoid touching_laser"),
        ("racing", "hit 90 m/s", "reach speed >= 90 m/s"),
        # Goals without a verb, and lists.
        ("platformer", "exit without key", "reach at_exit avoid has_key"),
        ("platformer", "get all coins without dying", "reach coins == 100 avoid died"),
        ("shooter", "10 headshots without reloading", "reach times(headshot) >= 10 avoid reloading"),
        ("puzzle", "solved, no undo, under 60 s", "require eventually within 60 s solved avoid undo"),
        ("racing", "checkpoint1 and checkpoint2 in order", "reach checkpoint1 then checkpoint2"),
        ("rpg", "stay poisoned for 20 s", "reach time_holding(poisoned) >= 20 s"),
        ("shooter", "rifle only", "keep weapon is rifle"),
        # Rules about a span of time, and about changes.
        ("racing", "no boosting in the first 10 s", "require always for 10 s not boosting"),
        ("racing", "no boosting from lap 2 on", "keep lap >= 2 implies always not boosting"),
        ("rpg", "spend no gold", "avoid gold < previous(gold)"),
        ("racing", "keep lap never decreases", "avoid lap < previous(lap)"),
        # Answers.
        ("stealth", "when alarm then no takedown until hidden", "keep alarm implies (not takedown weak_until hidden)"),
        ("stealth", "when mode becomes chase then alarm", "keep begins mode is chase implies alarm"),
        (
            "racing",
            "whenever off_track then not off_track within 4 s",
            "keep off_track implies eventually within 4 s not off_track",
        ),
        (
            "racing",
            "keep off_track implies not off_track within 4 s",
            "keep off_track implies eventually within 4 s not off_track",
        ),
        (
            "shooter",
            "whenever hit and aiming then not aiming within 2 steps",
            "keep hit and aiming implies eventually within 2 steps not aiming",
        ),
        (
            "stealth",
            "when mode == chase then keep mode == chase for 2 seconds",
            "keep begins mode is chase implies always for 2 s mode is chase",
        ),
        (
            "stealth",
            "when seen then reach mode >= alert within 0.5 seconds",
            "keep seen implies eventually within 0.5 s (mode is alert or mode is chase)",
        ),
        # Conditions, stretches of play, and what comes again.
        ("racing", "while in_pit keep speed == 0 m/s", "keep in_pit implies speed <= 0 m/s"),
        ("racing", "while in_pit avoid boosting || drifting", "avoid in_pit and (boosting or drifting)"),
        ("racing", "if (in_pit) { avoid boosting }", "avoid in_pit and boosting"),
        ("racing", "when off_track then keep off_track", "keep off_track implies always off_track"),
        ("racing", "once finished, always finished", "keep finished implies always finished"),
        (
            "racing",
            "once !finished: always !(boosting || drifting)",
            "keep not finished implies always not (boosting or drifting)",
        ),
        (
            "racing",
            "avoid off_track between checkpoint1 and checkpoint2",
            "keep begins checkpoint1 implies (not off_track weak_until checkpoint2)",
        ),
        (
            "racing",
            "between checkpoint1 and checkpoint2 keep boosting",
            "keep begins checkpoint1 implies (boosting weak_until checkpoint2)",
        ),
        ("racing", "each boosting lasts at least 2 s", "keep begins boosting implies always for 2 s boosting"),
        ("racing", "keep !braking at most 3 s", "keep time_holding(not braking) <= 3 s"),
        ("racing", "never off_track for more than 10 steps in a row", "keep time_holding(off_track) < 1 s"),
        ("racing", "at the end finished && !crashed", "require eventually always (finished and not crashed)"),
        (
            "racing",
            "keep at most one of (boosting, braking, drifting)",
            "avoid boosting and braking avoid boosting and drifting avoid braking and drifting",
        ),
        ("racing", "never finished without checkpoint1 before", "keep finished implies once checkpoint1"),
        ("racing", "assert !boosting || crashed within last 2 s", "keep boosting implies once within 2 s crashed"),
        # The functions and operators of code and of logic.
        ("racing", "keep lap >= prev(lap)", "keep lap >= previous(lap)"),
        ("racing", "keep (prev crashed && !crashed) => braking", "keep ends crashed implies braking"),
        ("racing", "on rise(finished): lap == 3", "keep begins finished implies lap == 3"),
        ("racing", "count(rising crashed) <= 2", "keep times(crashed) <= 2"),
        ("racing", "assert lap >= 1 || !finished", "keep lap >= 1 or not finished"),
        ("racing", "keep boosting == (lap > 2)", "keep boosting iff lap > 2"),
        (
            "racing",
            "whenever crashed, eventually (braking ^ drifting) within 1 s",
            "keep crashed implies eventually within 1 s (braking iff not drifting)",
        ),
        ("racing", "!finished U checkpoint1", "require not finished until checkpoint1"),
        ("racing", "GF boosting && G !crashed", "require (always eventually boosting) and always not crashed"),
        ("racing", "reach checkpoint1 and reach checkpoint2 in any order", "reach checkpoint1 reach checkpoint2"),
        ("racing", "eventually finished and always speed < 90 m/s", "reach finished keep speed < 90 m/s"),
        (
            "stealth",
            "keep seen implies mode != prev(mode)",
            "keep seen implies (previously mode is calm and mode is not calm) or "
            "(previously mode is alert and mode is not alert) or (previously mode is chase and mode is not chase)",
        ),
    ],
)
def test_the_first_fix_of_a_sentence_has_its_meaning(declarations: str, typed: str, meant: str) -> None:
    text, left = fix(spec(typed, declarations))
    assert not left
    assert is_equivalent(text, spec(meant, declarations))


@pytest.mark.parametrize(
    ("declarations", "typed"),
    [
        ("shooter", "headshot while downed"),
        ("rpg", "stay in town at night"),
        ("platformer", "has key while at door"),
        ("stealth", "crouch in the vault"),
        ("shooter", "dash while reloading"),
        ("shooter", "throw a grenade and kill within 3 s"),
        ("stealth", "seen, then hidden within 10 s"),
        ("stealth", "given hidden when alarm then mode is chase until seen"),
        ("puzzle", "bell at least once every 60 s"),
        ("racing", "after crashed avoid crashed for 1 s"),
        ("stealth", "stay disguised until in_vault"),
        ("stealth", "steal the keycard, enter the vault, leave by the exit"),
        ("platformer", "never pause during the boss fight"),
        ("platformer", "the boss"),
        ("platformer", "use the door"),
        ("platformer", "running without damage"),
        ("racing", "win the race without braking"),
        ("racing", "braking without drifting"),
        ("racing", "reach braking then finished twice"),
        ("racing", "if crashed then braking until finished"),
        ("rpg", "talk to the elder and kill the dragon"),
        ("rpg", "buy the sword with 50 gold"),
    ],
)
def test_a_sentence_with_two_readings_or_an_unknown_word_gets_no_fix(declarations: str, typed: str) -> None:
    assert first_error(typed, declarations).fixes == ()


def test_a_goal_or_a_rule_gets_both_readings() -> None:
    assert first_error("headshot while downed", "shooter").help == (
        "write `reach headshot and downed` if it is a goal, "
        "`keep downed implies headshot` if it is a rule for each step with `downed`"
    )


def test_an_event_that_is_asked_for_infinitely_often_needs_sessions_without_an_end() -> None:
    (fix_,) = first_error("reach finished infinitely often", "racing").fixes
    (edit,) = fix_.edits
    assert edit.text.split("\n") == ["semantics infinite", "require always eventually finished"]


@pytest.mark.parametrize(
    ("typed", "help_"),
    [
        (
            "when finished keep position <= 3",
            "write `keep finished implies position <= 3` if `position <= 3` must hold at each step with `finished`, "
            "`keep finished implies always position <= 3` if from then on",
        ),
        (
            "when crashed avoid boosting",
            "write `avoid crashed and boosting` to forbid `boosting` at each step with `crashed`, "
            "`keep crashed implies always not boosting` to forbid it from then on",
        ),
        (
            "when off_track then keep not off_track for 5 seconds",
            "write `avoid (begins off_track) then within 5 s (begins off_track)` if it may last, and must not begin "
            "again in that time, or `avoid off_track then within 5 s off_track` if no step with it may follow in that "
            "time, or `keep ends off_track implies always for 5 s not off_track` if the time counts from its end",
        ),
    ],
)
def test_a_rule_for_one_step_or_from_then_on_gets_both_readings(typed: str, help_: str) -> None:
    error = first_error(typed, "racing")
    assert ((error.help or "").splitlines()[0], error.fixes) == (help_, ())


@pytest.mark.parametrize("typed", ["keep count(crashed) <= 2", "avoid crashed twice in a row", "finally finished"])
def test_a_count_and_an_end_with_two_readings_get_no_fix(typed: str) -> None:
    assert first_error(typed, "racing").fixes == ()
