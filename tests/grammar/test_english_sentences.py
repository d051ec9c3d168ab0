"""Sentences of designers mean the clauses that the grammar of sentences reads from them."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import tltlc
from tests.grammar.phrases_as_typed import errors, fix, is_equivalent
from tltlc.core.source import SourceFile
from tltlc.grammar.english.phrases import PHRASES
from tltlc.grammar.english.readings import Meanings, Sentence, sentence
from tltlc.grammar.lexer import tokenize
from tltlc.grammar.mistakes.declared_names import declared_names
from tltlc.grammar.mistakes.sentences.calls import with_own_calls
from tltlc.grammar.mistakes.sentences.validity import is_valid
from tltlc.grammar.mistakes.sentences.vocabulary import ENGLISH
from tltlc.grammar.mistakes.sentences.words import Words, words_of
from tltlc.monitor import Monitor

HEAD = """\
clock 10 Hz
signal fire: bool
signal spray: bool
signal boss_dead: bool
signal coins: int in [0, 99]
signal lap: int in [0, 9]
signal health in [0, 100]
signal phase: (menu, shift, results)
signal state: (Idle, Dead)
"""

VARIES = "ends (phase is menu) or ends (phase is shift) or ends (phase is results)"
ONE_READING = {
    # Steps with a condition, and what an event or a time ends.
    "fire only after at least 3 steps with spray": [
        "keep fire implies once (spray and previously once (spray and previously once spray))"
    ],
    "fire only after more than 1 step with spray": ["keep fire implies once (spray and previously once spray)"],
    "keep begins (health <= 0) implies fire until (spray or 5 s)": [
        "keep begins (health <= 0) implies (always for 5 s fire) or (fire weak_until spray)"
    ],
    "keep fire until spray or 5 s": ["require (always for 5 s fire) or (fire weak_until spray)"],
    "fire until 5 s have passed or spray, whichever comes first": [
        "require (always for 5 s fire) or (fire weak_until spray)"
    ],
    "keep boss_dead implies fire until (spray or 5 s)": [
        "keep boss_dead implies (always for 5 s fire) or (fire weak_until spray)"
    ],
    "when boss_dead, fire until spray or for 5 s": [
        "keep boss_dead implies (always for 5 s fire) or (fire weak_until spray)"
    ],
    "when boss_dead, fire for 5 s or until spray": [
        "keep boss_dead implies (always for 5 s fire) or (fire weak_until spray)"
    ],
    "when boss_dead, for 5 s or until spray, fire": [
        "keep boss_dead implies (always for 5 s fire) or (fire weak_until spray)"
    ],
    "after boss_dead, no fire until spray or 5 s": [
        "keep boss_dead implies (always for 5 s not fire) or (not fire weak_until spray)"
    ],
    # So often with nothing in between.
    "fire 3 times without spray in between": ["reach times_since((begins fire) and not spray, spray) >= 3"],
    # Where an enum changes.
    "keep health <= value_at(health, phase changes) + 3": [f"keep health <= value_at(health, {VARIES}) + 3"],
    "keep times_since(fire, phase changed) <= 2": [f"keep times_since(fire, {VARIES}) <= 2"],
    "keep phase changed implies fire": [f"keep {VARIES} implies fire"],
    # The highest and the lowest value.
    "health never more than 20 above its lowest since fire": ["keep health <= lowest_since(health, begins fire) + 20"],
    "health never drops more than 20 below its highest": ["keep health >= highest(health) - 20"],
    "health stays within 20 of its lowest so far": ["keep health <= lowest(health) + 20"],
    "coins at most 2 below its highest since fire": ["keep coins >= highest_since(coins, begins fire) - 2"],
    # Since an event, and in each period.
    "keep times(fire) since spray <= 2": ["keep times_since(fire, spray) <= 2"],
    "times(fire) <= 9 since spray": ["keep times_since(fire, spray) <= 9"],
    "fire at most once since last spray": ["keep times_since(fire, spray) <= 1"],
    "fire at most 9 times since spray": ["keep times_since(fire, spray) <= 9"],
    "never more than 2 fire since the last spray": ["keep times_since(fire, spray) <= 2"],
    "at most 2 fire since spray started": ["keep times_since(fire, begins spray) <= 2"],
    "since the last spray, at most 2 fire": ["keep times_since(fire, spray) <= 2"],
    "no more than 2 fire after each spray": ["keep times_since(fire, spray) <= 2"],
    "number of fire since spray at most 2": ["keep times_since(fire, spray) <= 2"],
    "fire at least 2 times since spray": ["reach times_since(fire, spray) >= 2"],
    "when fire 3 times since spray, boss_dead": ["keep times_since(fire, spray) >= 3 implies boss_dead"],
    "if fire at least 3 times since the last spray then boss_dead": [
        "keep times_since(fire, spray) >= 3 implies boss_dead"
    ],
    "when fire 3 times without spray then boss_dead": ["keep times_since(fire, spray) >= 3 implies boss_dead"],
    "(fire and spray) for at most 9 s in total": ["keep total_time(fire and spray) <= 9 s"],
    "when times(fire) since spray > 3 then boss_dead": ["keep times_since(fire, spray) > 3 implies boss_dead"],
    "at most 2 fire in each lap": ["keep times_since(fire, lap != previous(lap)) <= 2"],
    "keep times(fire) <= 2 per lap": ["keep times_since(fire, lap != previous(lap)) <= 2"],
    "each lap, at most 2 fire": ["keep times_since(fire, lap != previous(lap)) <= 2"],
    "fire max 2 per lap": ["keep times_since(fire, lap != previous(lap)) <= 2"],
    "2 fire per lap at most": ["keep times_since(fire, lap != previous(lap)) <= 2"],
    "no more than 3 fire in one lap": ["keep times_since(fire, lap != previous(lap)) <= 3"],
    "never more than 3 fire per lap": ["keep times_since(fire, lap != previous(lap)) <= 3"],
    "at least 2 fire per lap": [
        "keep lap != previous(lap) implies previously (times_since(fire, lap != previous(lap)) >= 2)"
    ],
    "at most 2 fire in each state": ["keep times_since(fire, ends (state is Idle) or ends (state is Dead)) <= 2"],
    "at most one fire per begins spray": ["keep times_since(fire, begins spray) <= 1"],
    "keep times(fire) <= 1 per phase is results": [
        "keep phase is results implies times_since(fire, begins phase is results) <= 1"
    ],
    "no more than 3 fire between two spray": ["keep times_since(fire, spray) <= 3"],
    "at most 2 fire between spray and the next spray": ["keep times_since(fire, spray) <= 2"],
    "between spray and spray at most 2 fire": ["keep times_since(fire, spray) <= 2"],
    "fire at most once between spray and spray": ["keep times_since(fire, spray) <= 1"],
    "at most 2 fire between spray and boss_dead": [
        "keep (not boss_dead since begins spray) implies times_since(fire, begins spray) <= 2"
    ],
    "at least 2 fire between spray and boss_dead": [
        "keep begins boss_dead and previously (not boss_dead since begins spray) implies "
        "previously (times_since(fire, begins spray) >= 2)"
    ],
    "at least 3 fire before spray after each spray": [
        "keep begins spray and previously once spray implies previously (times_since(fire, begins spray) >= 3)"
    ],
    "exactly one fire between spray and the next spray": [
        "keep begins spray and previously once spray implies previously (times_since(fire, begins spray) == 1)",
        "keep once spray implies times_since(fire, begins spray) <= 1",
    ],
    # Times in total.
    "fire at most 3 times in total": ["keep times(fire) <= 3"],
    "fire total time under 20 s": ["keep total_time(fire) < 20 s"],
    "fire for at most 4 s in total": ["keep total_time(fire) <= 4 s"],
    "fire for at most 60 s in all since spray": ["keep total_time_since(fire, spray) <= 60 s"],
    "keep fire at most 60 s since the last spray": ["keep total_time_since(fire, spray) <= 60 s"],
    "fire for at most 20 steps in total": ["keep total_time(fire) <= 2 s"],
    "total time fire at most 30 s": ["keep total_time(fire) <= 30 s"],
    "total(fire) <= 30 s": ["keep total_time(fire) <= 30 s"],
    "fire at most 30 s altogether": ["keep total_time(fire) <= 30 s"],
    "fire at most 30 s in the whole run": ["keep total_time(fire) <= 30 s"],
    "fire at most 30 s overall": ["keep total_time(fire) <= 30 s"],
    "fire at most 30 s cumulative": ["keep total_time(fire) <= 30 s"],
    "in total, fire for at most 30 s": ["keep total_time(fire) <= 30 s"],
    "at most 30 s of fire in total": ["keep total_time(fire) <= 30 s"],
    "never fire for more than 30 s in total": ["keep total_time(fire) <= 30 s"],
    "fire must not be on for more than 30 s in total": ["keep total_time(fire) <= 30 s"],
    "spend at most 30 s fire in total": ["keep total_time(fire) <= 30 s"],
    "total fire time < 30 s": ["keep total_time(fire) < 30 s"],
    "time spent fire in all < 60 s": ["keep total_time(fire) < 60 s"],
    "fire and spray for at most 5 s in total": ["keep total_time(fire and spray) <= 5 s"],
    "fire for at least 20 s in total": ["reach total_time(fire) >= 20 s"],
    "reach fire for 20 s in total": ["reach total_time(fire) >= 20 s"],
    "fire for a total of 20 s": ["reach total_time(fire) >= 20 s"],
    "when fire for 20 s in total, spray": ["keep total_time(fire) >= 20 s implies spray"],
    # A second one of several.
    "after fire and spray, no fire until coins > 3": [
        "keep fire and spray implies weak_next (not fire weak_until coins > 3)"
    ],
    # Just before.
    "if spray then health > 20 for the last 2 s": ["keep spray implies time_holding(health > 20) >= 2 s"],
    "never fire while coins > 3 unless spray in the last 5 s": [
        "keep fire and coins > 3 implies once within 5 s spray"
    ],
    # Between two times.
    "if spray then once between 0.2 s and 1 s fire": [
        "keep spray implies previously previously once within 0.8 s fire"
    ],
    # Counts in the last seconds.
    "fire never happens three times within 5 s": ["keep times_within(fire, 5 s) < 3"],
    "avoid more than 2 times fire within 5 s": ["keep times_within(fire, 5 s) <= 2"],
    "fire at most 3 times within any 10 s": ["keep times_within(fire, 10 s) <= 3"],
    "if fire happens 3 times within 10 s then spray": ["keep times_within(fire, 10 s) >= 3 implies spray"],
    "three fire in 10 s implies spray": ["keep times_within(fire, 10 s) >= 3 implies spray"],
    "spray only if fire at least 3 times in any 10 s": ["keep spray implies times_within(fire, 10 s) >= 3"],
    # Values at events.
    "the highest coins since fire stays under 30": ["keep highest_since(coins, begins fire) < 30"],
    "when fire then coins == coins at last spray": ["keep fire implies coins == value_at(coins, spray)"],
    "when fire ends then coins >= (coins when fire started) + 5": [
        "keep ends fire implies coins >= (value_at(coins, begins fire)) + 5"
    ],
    "when fire ends, coins >= coins when it began": ["keep ends fire implies coins >= value_at(coins, begins fire)"],
    "coins after fire >= coins when it began": ["keep ends fire implies coins >= value_at(coins, begins fire)"],
    "coins at end of fire >= coins at start of fire + 5": [
        "keep ends fire implies coins >= value_at(coins, begins fire) + 5"
    ],
    "when fire then coins > coins when phase became shift": [
        "keep fire implies coins > value_at(coins, begins (phase is shift))"
    ],
    "keep fire implies coins >= (coins at begins phase is shift) - 3": [
        "keep fire implies coins >= (value_at(coins, begins (phase is shift))) - 3"
    ],
    "when fire, coins must be less than at the start of shift": [
        "keep fire implies coins < value_at(coins, begins (phase is shift))"
    ],
    "when fire, health must be at least what it was when spray began": [
        "keep fire implies health >= value_at(health, begins spray)"
    ],
    "when fire ends, more coins than when fire started": [
        "keep ends fire implies coins > value_at(coins, begins fire)"
    ],
    "when fire ends, at least as many coins as when fire began": [
        "keep ends fire implies coins >= value_at(coins, begins fire)"
    ],
    "in fire health stays within 15 of its value when fire began": [
        "keep fire implies abs(health - value_at(health, begins fire)) <= 15"
    ],
    "while fire, abs(coins - coins@fire) <= 15": ["keep fire implies abs(coins - value_at(coins, begins fire)) <= 15"],
    "during fire health never below health at start of fire": [
        "keep fire implies health >= value_at(health, begins fire)"
    ],
    "keep health drops by at most 40 since ends fire": ["keep health >= value_at(health, ends fire) - 40"],
    "gain no more than 50 coins per lap": ["keep coins <= value_at(coins, lap != previous(lap)) + 50"],
    "gain at least 10 coins per lap": [
        "keep lap != previous(lap) implies coins >= previous(value_at(coins, lap != previous(lap))) + 10"
    ],
    "keep fire implies after 0.2 s spray": ["keep fire implies next after 0.2 s spray"],
    "phase is shift begins exactly 0.2 s after fire": ["keep fire implies next after 0.2 s begins (phase is shift)"],
    "avoid fire then spray without boss_dead": ["avoid spray and previously (not boss_dead since fire)"],
    "no spray after fire without boss_dead in between": ["avoid spray and previously (not boss_dead since fire)"],
    "when phase becomes results and coins >= 30 then health < 3": [
        "keep begins (phase is results) and coins >= 30 implies health < 3"
    ],
    "avoid fire and not spray for more than 3 s": ["avoid time_holding(fire and not spray) > 3 s"],
    "avoid fire for more than 5 steps": ["avoid always for 5 steps fire and next after 5 steps fire"],
    "whenever health falls below 20 then spray within 2 s": [
        "keep begins (health < 20) implies eventually within 2 s spray"
    ],
    "when health falls below 20, spray": ["keep health < 20 implies spray"],
    "fire starts only if spray for at least 5 s": ["keep begins fire implies time_holding(spray) >= 5 s"],
    "fire only after spray for 3 s": ["keep begins fire implies time_holding(spray) >= 3 s"],
    "avoid fire unless spray since last fire": ["keep fire implies previously (not fire since (spray and not fire))"],
    "keep health never decreases unless fire": ["keep health >= previous(health) or fire"],
    "whenever fire starts keep fire for exactly 4 steps": [
        "keep begins fire implies (always for 4 steps fire) and weak_next after 4 steps not fire"
    ],
    "keep spray implies fire within 3 s before": ["keep spray implies once within 3 s fire"],
    "phase changes only when fire": [
        "keep ends (phase is menu) or ends (phase is shift) or ends (phase is results) implies fire"
    ],
    "when fire, coins > coins at start": ["keep fire implies coins > initial(coins)"],
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
    "fire only if spray since fire": ["keep fire implies previously (not fire since (spray and not fire))"],
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
    "avoid fire between spray and spray": ["avoid fire and not spray and previously once spray"],
    "between spray and boss_dead reach fire": [
        "keep boss_dead and previously (not boss_dead since spray) implies "
        "previously (not boss_dead since (fire and not boss_dead and previously (not boss_dead since spray)))"
    ],
    "from spray until boss_dead avoid fire": ["keep begins spray implies (not fire weak_until boss_dead)"],
    "avoid fire after spray until boss_dead": ["keep spray implies (not fire weak_until boss_dead)"],
    "begins fire exactly once between spray and boss_dead": [
        "keep spray implies weak_next ((not begins fire and not boss_dead) weak_until "
        "(begins fire and not boss_dead and weak_next (not begins fire weak_until boss_dead)))"
    ],
    "no more than 3 s without fire": ["avoid time_holding(not fire) > 3 s"],
    "never go 3 s without fire": ["avoid time_holding(not fire) >= 3 s"],
    "fire lasts at least 2 s": ["keep begins fire implies always for 2 s fire"],
    "each fire lasts between 1 and 2 s": [
        "keep begins fire implies always for 1 s fire",
        "avoid time_holding(fire) > 2 s",
    ],
    "fire lasts exactly 3 steps": [
        "keep begins fire implies (always for 3 steps fire) and weak_next after 3 steps not fire"
    ],
    "fire for at most 3 steps in total": ["avoid fire then fire then fire then fire"],
    "phase only goes menu then shift then results then menu": [
        "keep phase is menu implies weak_next (phase is menu or phase is shift)",
        "keep phase is shift implies weak_next (phase is shift or phase is results)",
        "keep phase is results implies weak_next (phase is results or phase is menu)",
    ],
    "phase can only go menu -> shift -> results": [
        "keep phase is menu implies weak_next (phase is menu or phase is shift)",
        "keep phase is shift implies weak_next (phase is shift or phase is results)",
        "keep phase is results implies weak_next phase is results",
    ],
    "phase becomes results only from shift": ["keep begins (phase is results) implies previously phase is shift"],
    "phase leaves menu only to shift": ["keep ends (phase is menu) implies phase is shift"],
    "reach fire, spray and boss_dead in any order": ["reach fire", "reach spray", "reach boss_dead"],
    "reach fire and spray within 5 s in any order": [
        "require eventually within 5 s fire",
        "require eventually within 5 s spray",
    ],
    "reach fire, spray in any order then boss_dead": ["reach fire then boss_dead", "reach spray then boss_dead"],
    "phase becomes results": ["reach phase is results"],
    "keep fire == (phase == menu or phase == shift)": ["keep fire iff phase is menu or phase is shift"],
    "when fire for the last 2 s then spray": ["keep time_holding(fire) >= 2 s implies spray"],
    "keep health < 3 when fire has been true for 2 s": ["keep time_holding(fire) >= 2 s implies health < 3"],
    "avoid fire and spray unless boss_dead": ["keep (fire and spray) implies boss_dead"],
    "avoid fire unless spray for 3 frames": [
        "keep fire implies historically for 3 steps spray and previously previously true"
    ],
    "keep if fire then spray between 0.1 s and 0.3 s before": ["keep fire implies previously once within 0.2 s spray"],
    "when fire then spray between 2 and 4 steps later": [
        "keep fire implies next after 2 steps eventually within 2 steps spray"
    ],
    "when phase becomes shift while fire, spray within 3 s": [
        "keep begins (phase is shift) and fire implies eventually within 3 s spray"
    ],
    "G (fire -> spray or not boss_dead)": ["keep fire implies spray or not boss_dead"],
    "keep spray -> Y((!fire) S boss_dead)": ["keep spray implies previously (not fire since boss_dead)"],
    "fire => prev(phase) == menu": ["keep fire implies previously (phase is menu)"],
    "fire -> spray unless boss_dead": ["keep fire implies spray or boss_dead"],
    "coins >= prev(coins) unless phase == menu": ["keep coins >= previous(coins) or phase is menu"],
    "abs(coins - prev(coins)) <= 1": ["keep abs(coins - previous(coins)) <= 1"],
    "|health - health'| <= 4": ["keep abs(health - previous(health)) <= 4"],
    "health <= min(health so far)": ["keep health <= lowest(health)"],
    "health <= prev health, always": ["keep health <= previous(health)"],
    "G(health >= 0.5 * health@0)": ["keep health >= 0.5 * initial(health)"],
    "fire xor (phase == menu or phase == shift)": ["keep fire iff not (phase is menu or phase is shift)"],
    "duration(fire) <= 3s": ["keep time_holding(fire) <= 3 s"],
    "fire => within(5s, spray || boss_dead)": ["keep fire implies eventually within 5 s (spray or boss_dead)"],
    "on(fire): spray for 1.5s": ["keep fire implies always for 1.5 s spray"],
    "F[<=3min] (boss_dead && coins > 40)": ["require eventually within 3 min (boss_dead and coins > 40)"],
    "never: prev(phase) == menu and phase == results": ["avoid previously (phase is menu) and phase is results"],
    "G(fire -> X G phase == menu)": ["keep fire implies weak_next always phase is menu"],
    "when fire: (not spray) U[<=20s] boss_dead": [
        "keep fire implies eventually within 20 s boss_dead",
        "keep fire implies (not spray until boss_dead)",
    ],
    "phase == menu -> phase == shift -> phase == results -> fire": [
        "reach phase is menu then phase is shift then phase is results then fire"
    ],
    "fire then spray then reach boss_dead": ["reach fire then spray then boss_dead"],
    "menu -> results is forbidden": ["avoid previously (phase is menu) and phase is results"],
    "phase: menu -> results is not allowed": ["avoid previously (phase is menu) and phase is results"],
    "no transition from menu to results": ["avoid previously (phase is menu) and phase is results"],
    "never go from menu to results": ["avoid previously (phase is menu) and phase is results"],
    "phase must not go from menu straight to results": ["avoid previously (phase is menu) and phase is results"],
    "phase only goes to results from shift": ["keep begins (phase is results) implies previously phase is shift"],
    "results only from shift": ["keep begins (phase is results) implies previously phase is shift"],
    "coins only decreases while fire": ["keep coins < previous(coins) implies fire"],
    "fire only starts when spray": ["keep begins fire implies spray"],
    "once phase is results it stays results": ["keep phase is results implies always phase is results"],
    "once fire it stays that way": ["keep fire implies always fire"],
    "fire never lasts longer than 10 s": ["avoid time_holding(fire) > 10 s"],
    "spray for 5 seconds at some point": ["reach time_holding(spray) >= 5 s"],
    "boss_dead then spray holds 10 s": ["reach boss_dead then time_holding(spray) >= 10 s"],
    "finish with at least as many coins as you started with": ["require eventually always coins >= initial(coins)"],
    "while fire, coins may not grow by more than 2 per step": ["keep fire implies coins <= previous(coins) + 2"],
    "health may change by at most 2 per step": ["keep abs(health - previous(health)) <= 2"],
    "coins never increases by more than 2": ["keep coins <= previous(coins) + 2"],
    "health never drops below 20": ["keep health >= 20"],
    "health stays above 20": ["keep health > 20"],
    "when health falls below 20 then spray within 1 s for at least 3 s": [
        "keep begins (health < 20) implies eventually within 1 s always for 3 s spray"
    ],
    "when fire, spray within 1 s for 3 s": ["keep fire implies eventually within 1 s always for 3 s spray"],
    "no fire for 2 s after spray starts": ["keep begins spray implies always for 2 s not fire"],
    "keep boss_dead for 2 s after spray": ["keep spray implies always for 2 s boss_dead"],
    "phase stays menu or shift": ["keep phase is menu or phase is shift"],
    "if fire then spray within a second": ["keep fire implies eventually within 1 s spray"],
    # How long each stretch lasts, and how often.
    "each spray lasts exactly 3 s": [
        "keep begins spray implies always for 3 s spray",
        "avoid time_holding(spray) > 3 s",
    ],
    "phase shift must last exactly 3 s": [
        "keep begins phase is shift implies always for 3 s phase is shift",
        "avoid time_holding(phase is shift) > 3 s",
    ],
    "each spray lasts 1 to 3 s": ["keep begins spray implies always for 1 s spray", "avoid time_holding(spray) > 3 s"],
    "spray lasts between 500 ms and 3 s": [
        "keep begins spray implies always for 500 ms spray",
        "avoid time_holding(spray) > 3 s",
    ],
    "spray must not last longer than 1.5 s": ["avoid time_holding(spray) > 1.5 s"],
    "spray can't go on for more than 2 s": ["avoid time_holding(spray) > 2 s"],
    "never spray longer than 2 s": ["avoid time_holding(spray) > 2 s"],
    "spray must not last less than 2 s": ["keep begins spray implies always for 2 s spray"],
    "hold spray for 5 s without fire": ["reach time_holding(spray and not fire) >= 5 s"],
    "phase menu must occur exactly once": ["reach times(phase is menu) >= 1", "keep times(phase is menu) <= 1"],
    "fire 3 times during phase == shift, then boss_dead": [
        "reach times((begins fire) and phase is shift) >= 3 then boss_dead"
    ],
    "for the first 2 min: not fire": ["require always for 2 min not fire"],
    "phase is menu for the first 3 s": ["require always for 3 s phase is menu"],
    "fire must not happen in the first 3 s": ["require always for 3 s not fire"],
    "health drops below 20 at some point\nbut never below 5": ["reach health < 20", "keep health >= 5"],
    "spray can only last 10 s": ["avoid time_holding(spray) > 10 s"],
    "spray has to last at least 2 s": ["keep begins spray implies always for 2 s spray"],
    # Answers.
    "after fire ends, spray must not happen for 2 s": ["keep ends fire implies always for 2 s not spray"],
    "when fire, phase must be menu within 3 s and stay menu": [
        "keep fire implies eventually within 3 s always phase is menu"
    ],
    "when fire\nthen health is 3 or less within 5 s\nand stays so": [
        "keep fire implies eventually within 5 s always health <= 3"
    ],
    "given phase is menu\nwhen fire\nthen spray within 2 s": [
        "keep phase is menu and fire implies eventually within 2 s spray"
    ],
    "at boss_dead: coins > coins at start": ["keep boss_dead implies coins > initial(coins)"],
    "fire must be followed by spray within 3 s": ["keep fire implies eventually within 3 s spray"],
    "every fire must be answered by spray within 3 s": ["keep fire implies eventually within 3 s spray"],
    "every fire must be spray within 3 s": ["keep fire implies eventually within 3 s spray"],
    "not fire for 30 s => phase menu": ["keep time_holding(not fire) >= 30 s implies phase is menu"],
    "phase starts shift => spray within 1 s": ["keep begins (phase is shift) implies eventually within 1 s spray"],
    "when boss_dead, boss_dead": ["keep boss_dead implies always boss_dead"],
    "fire must be shown if and only if phase is menu": ["keep fire iff phase is menu"],
    "when fire then health must be 0": ["keep fire implies health <= 0"],
    "when phase is shift ends, health is 0 within 3 s and remains 0": [
        "keep ends (phase is shift) implies eventually within 3 s always health <= 0"
    ],
    "while phase is shift, when fire, spray within 0.5 s": [
        "keep phase is shift and fire implies eventually within 0.5 s spray"
    ],
    # Numbers.
    "health may rise by at most 30 per step": ["keep health <= previous(health) + 30"],
    "when fire, coins must be 3 or fewer": ["keep fire implies coins <= 3"],
    "coins must not increase by more than 1 per step": ["keep coins <= previous(coins) + 1"],
    "health never drops by more than 10 at once": ["keep health >= previous(health) - 10"],
    "coins only go up": ["keep coins >= previous(coins)"],
    "coins never falls; never fire": ["keep coins >= previous(coins)", "avoid fire"],
    "health doesn't stay the same for more than 3 s": [
        "avoid time_holding(health <= previous(health) and health >= previous(health)) > 3 s"
    ],
    "both coins and health over 40 within 4 min": ["require eventually within 4 min (coins > 40 and health > 40)"],
    "when phase is menu\nthen coins is 3 or 4": ["keep phase is menu implies coins == 3 or coins == 4"],
    "avoid |coins - health| > 60": ["avoid abs(coins - health) > 60"],
    "coins never above the highest health so far": ["keep coins <= highest(health)"],
    "fire only when coins higher than 0.2 s ago": ["keep fire implies coins > previous(coins, 0.2 s)"],
    "coins only when phase is shift": ["keep coins > 0 implies phase is shift"],
    "when fire, no coins": ["keep fire implies coins == 0"],
    "when boss_dead, more coins than at the start": ["keep boss_dead implies coins > initial(coins)"],
    # Exceptions.
    "never phase is shift when health < 5 unless boss_dead": ["keep phase is shift and health < 5 implies boss_dead"],
    "avoid fire if spray unless boss_dead": ["keep fire and spray implies boss_dead"],
    "never fire when spray and health < 5 unless boss_dead": ["keep fire and spray and health < 5 implies boss_dead"],
    "fire must not happen while spray unless boss_dead": ["keep fire and spray implies boss_dead"],
    "phase is not shift before phase is menu": ["require phase is not shift weak_until phase is menu"],
    "keep fire implies coins <= 9 and (lap >= 1 except spray)": [
        "keep fire implies coins <= 9 and (lap >= 1 or spray)"
    ],
    "keep fire implies health > 5 except when spray or boss_dead": [
        "keep fire implies health > 5 or (spray or boss_dead)"
    ],
    "keep health > 5 except spray or boss_dead": ["keep health > 5 or (spray or boss_dead)"],
    "keep fire implies coins <= 9 except within 5 s after begins spray": [
        "keep fire implies coins <= 9 or once within 5 s begins spray"
    ],
    "keep coins <= 9 except in the first 5 s of spray": ["keep coins <= 9 or once within 5 s begins spray"],
    # Two conditions.
    "never both once fire and once spray": ["avoid once fire and once spray"],
    "never both coins > 3 and begins spray": ["avoid coins > 3 and begins spray"],
    "when fire, never both spray and boss_dead": ["keep fire implies not (spray and boss_dead)"],
    "never both spray and boss_dead when fire": ["keep fire implies not (spray and boss_dead)"],
    "keep lap >= 1 and (health > 5 unless spray)": ["keep lap >= 1 and (health > 5 or spray)"],
    # What must not change while something holds.
    "when spray, coins may not exceed 5": ["keep spray implies coins <= 5"],
    "when spray coins must not be more than 5": ["keep spray implies coins <= 5"],
    "phase must not go from menu to results directly": ["avoid previously (phase is menu) and phase is results"],
    "cannot go straight from menu to results": ["avoid previously (phase is menu) and phase is results"],
    # Windows.
    "when fire begins, spray after at least 0.5 s and at most 2 s": [
        "keep begins fire implies next after 0.5 s eventually within 1.5 s spray"
    ],
    "spray at least 0.5 s and at most 2 s after fire": [
        "keep fire implies next after 0.5 s eventually within 1.5 s spray"
    ],
    "fire only if spray was at most 5 s ago": ["keep fire implies once within 5 s spray"],
    "when fire, spray within 5 s and then stays so": ["keep fire implies eventually within 5 s always spray"],
    "when fire, spray within 5 steps and stays so for 3 steps": [
        "keep fire implies eventually within 5 steps always for 3 steps spray"
    ],
    # The order of conditions.
    "phase shift must always directly follow menu": ["keep begins phase is shift implies previously phase is menu"],
    "phase is menu must be immediately followed by phase is shift": ["keep ends phase is menu implies phase is shift"],
    "phase never goes directly from menu to results": ["avoid previously (phase is menu) and phase is results"],
    "from phase is menu you can't go straight to phase is results": [
        "avoid previously phase is menu and phase is results"
    ],
    "phase shift only after menu, results only after shift": [
        "keep phase is shift implies once phase is menu",
        "keep phase is results implies once phase is shift",
    ],
    "reach fire, spray and boss_dead in any order, then phase is menu": [
        "reach fire then phase is menu",
        "reach spray then phase is menu",
        "reach boss_dead then phase is menu",
    ],
}

AGAIN = [
    ("avoid (begins fire) then within 2 s (begins fire)", "if it may last, and must not begin again in that time"),
    ("avoid fire then within 2 s fire", "if no step with it may follow in that time"),
    ("keep ends fire implies always for 2 s not fire", "if the time counts from its end"),
]
APART = [
    ("avoid (begins fire) then within 2 s (begins fire)", "if steps in a row count once"),
    ("avoid fire then within 2 s fire", "if each step counts"),
]
WHILE = [
    ("keep spray implies times_since(fire, begins spray) <= 3", "if each `spray` begins a new count"),
    ("keep times((begins fire) and spray) <= 3", "if all steps with `spray` count together"),
]
SEVERAL = [
    ("keep times_since(fire, spray) >= 2 implies eventually within 5 s spray", "if each `spray` begins a new count"),
    (
        "keep begins (times(fire) >= 2) implies eventually within 5 s spray",
        "if it counts from the first step on, and asks for it once",
    ),
]
IN_ALL_OR_EACH = [
    ("keep fire implies health >= value_at(health, begins fire) - 15", "if it counts from where `fire` began"),
    ("keep fire implies health >= previous(health) - 15", "for each step with `fire`"),
]
SAME_WHILE = [
    (
        "keep fire and previously fire implies health >= previous(health) and health <= previous(health)",
        "within each `fire`",
    ),
    (
        "keep fire implies health >= previous(health) and health <= previous(health)",
        "also from the step before it begins",
    ),
]
INT_SAME_WHILE = [
    ("keep fire and previously fire implies coins == previous(coins)", "within each `fire`"),
    ("keep fire implies coins == previous(coins)", "also from the step before it begins"),
]
DENIED_AFTER = [
    ("keep spray implies always for 2 s not fire", "from each step with `spray` on"),
    ("keep ends spray implies always for 2 s not fire", "from its end on"),
]
NO_FALL_WHILE = [
    ("keep fire and previously fire implies health >= previous(health)", "within each `fire`"),
    ("keep fire implies health >= previous(health)", "also from the step before it begins"),
]
ONE_PER = [
    ("keep times_since(fire, begins spray) <= 1", "if at most 1, and each `begins spray` begins a new count"),
    (
        "keep ends spray implies previously (times_since(fire, begins spray) >= 1)",
        "if at least 1, asked for where one ends",
    ),
]
NOT_AGAIN_UNTIL = [
    (
        "keep begins fire implies weak_next (not begins fire weak_until (spray or boss_dead))",
        "if steps in a row count once",
    ),
    ("keep fire implies weak_next (not fire weak_until (spray or boss_dead))", "if each step counts"),
]
ONCE_OR_ANEW = [
    (
        "keep begins (time_holding(not fire) >= 8 s) implies eventually within 2 s spray",
        "if once each time that this begins",
    ),
    (
        "keep time_holding(not fire) >= 8 s implies eventually within 2 s spray",
        "if anew at each step while it lasts",
    ),
]
NO_SOONER = [
    (
        "keep fire implies (always for 0.5 s not spray) and next after 0.5 s eventually within 1.5 s spray",
        "if `spray` must not come earlier",
    ),
    ("keep fire implies next after 0.5 s eventually within 1.5 s spray", "if `spray` may come earlier, too"),
]
LONG_AGO = [
    ("keep fire implies time_holding(once spray) >= 5 s", "if some `spray` was at least 5 s ago"),
    (
        "keep fire implies once spray and time_since(spray) >= 5 s",
        "if the last `spray` was, and none has come since then",
    ),
]
LONG_AGO_IN_STEPS = [
    ("keep fire implies time_holding(once spray) >= 5 s", "if some `spray` was at least 50 steps ago"),
    LONG_AGO[1],
]
NOT_SOON_AFTER = [
    (
        "keep fire implies time_since(spray) >= 5 s",
        "if no `spray` may be less than 5 s ago, and none need have come",
    ),
    *LONG_AGO,
]
NOT_BEFORE_UNLESS = [
    ("keep fire implies once spray or boss_dead", "if `boss_dead` counts only at the step with `fire`"),
    ("keep fire implies once (spray or boss_dead)", "if an earlier `boss_dead` counts, too"),
]
STAYS_UNTIL = [
    (
        "keep begins fire implies eventually within 5 s (health < 5 and (health < 5 weak_until spray))",
        "if play may end before `spray`",
    ),
    (
        "keep begins fire implies eventually within 5 s (health < 5 and (health < 5 until spray))",
        "if `spray` must come",
    ),
]
SEVERAL_READINGS = {
    "fire not before spray unless boss_dead": NOT_BEFORE_UNLESS,
    "not fire before spray unless boss_dead": NOT_BEFORE_UNLESS,
    "never fire before spray unless boss_dead": NOT_BEFORE_UNLESS,
    "keep coins <= 9 and lap >= 1 unless spray": [
        ("keep (coins <= 9 and lap >= 1) or spray", "if `spray` is an exception of all before it"),
        ("keep coins <= 9 and (lap >= 1 or spray)", "if it is one of `lap >= 1` alone"),
    ],
    "keep fire implies coins <= 9 and lap >= 1 unless spray": [
        ("keep fire implies coins <= 9 and lap >= 1 or spray", "if `spray` excuses all of it"),
        ("keep fire implies coins <= 9 and (lap >= 1 or spray)", "if `spray` excuses `lap >= 1` alone"),
    ],
    "keep coins <= 9 except within 5 s after spray": [
        ("keep coins <= 9 or once within 5 s begins spray", "if the time counts from where `spray` begins"),
        ("keep coins <= 9 or once within 5 s spray", "if it counts from each step with `spray`"),
    ],
    "keep coins <= 3 and coins == 0 if phase is menu": [
        ("keep coins <= 3", "keep phase is menu implies coins == 0", "if `coins <= 3` must hold at every step"),
        (
            "keep phase is menu implies coins <= 3 and coins == 0",
            "if all of it is asked for with `phase is menu` alone",
        ),
    ],
    "keep fire and spray if boss_dead": [
        ("keep fire", "keep boss_dead implies spray", "if `fire` must hold at every step"),
        ("keep boss_dead implies fire and spray", "if all of it is asked for with `boss_dead` alone"),
    ],
    "while spray health must not rise": [
        ("keep spray and previously spray implies health <= previous(health)", "within each `spray`"),
        ("keep spray implies health <= previous(health)", "also from the step before it begins"),
    ],
    "while spray, coins must not be more than previous(coins)": [
        ("keep spray and previously spray implies coins <= previous(coins)", "within each `spray`"),
        ("keep spray implies coins <= previous(coins)", "also from the step before it begins"),
    ],
    "keep times(fire) <= 5 and no two fire within 2 s": [
        ("keep times(fire) <= 5", "avoid (begins fire) then within 2 s (begins fire)", "if steps in a row count once"),
        ("keep times(fire) <= 5", "avoid fire then within 2 s fire", "if each step counts"),
    ],
    "keep times(fire) <= 5 and fire at most once every 2 s": [
        ("keep times(fire) <= 5", "avoid (begins fire) then within 2 s (begins fire)", "if steps in a row count once"),
        ("keep times(fire) <= 5", "avoid fire then within 2 s fire", "if each step counts"),
    ],
    "when fire, spray no sooner than 0.5 s and no later than 2 s": NO_SOONER,
    "when fire, spray after 0.5 s at the earliest and 2 s at the latest": NO_SOONER,
    "when fire, spray within 2 s but no sooner than 0.5 s": NO_SOONER,
    "spray no sooner than 0.5 s and no later than 2 s after fire": NO_SOONER,
    "fire only if spray happened at least 5 s ago": LONG_AGO,
    "fire only if spray was at least 50 steps ago": LONG_AGO_IN_STEPS,
    "fire no sooner than 5 s after spray": NOT_SOON_AFTER,
    "fire only at least 5 s after spray": NOT_SOON_AFTER,
    "after begins fire, health < 5 within 5 s and then stays until spray": STAYS_UNTIL,
    "after begins fire, health < 5 within 5 s and stays there until spray": STAYS_UNTIL,
    "after begins fire, health < 5 within 5 s and then stays so until spray": STAYS_UNTIL,
    "after begins fire, health < 5 within 5 s and then stays stopped until spray": STAYS_UNTIL,
    "reach times(fire) >= 3 before phase is menu": [
        (
            "require phase is not menu until (times(fire) >= 3 and phase is not menu)",
            "if it must come, and `phase is menu` neither before it nor with it",
        ),
        (
            "require phase is not menu until times(fire) >= 3",
            "if it must come, and `phase is menu` may come at the same step",
        ),
        (
            "require phase is not menu weak_until times(fire) >= 3",
            "if it need not come, and `phase is menu` may come at the same step",
        ),
        (
            "reach times(fire) >= 3 then phase is menu",
            "if `phase is menu` must follow at a later step, and may come earlier, too",
        ),
    ],
    "reach fire then spray then boss_dead with no lap > 3 in between": [
        (
            "reach fire and lap <= 3 and next (lap <= 3 until (spray and lap <= 3 and next (lap <= 3 until "
            "(boss_dead and lap <= 3))))",
            "if no step from `fire` to `boss_dead` may have it, these two included",
        ),
        (
            "reach fire and next (lap <= 3 until (spray and lap <= 3 and next (lap <= 3 until boss_dead)))",
            "if only no step between `fire` and `boss_dead` may have it",
        ),
    ],
    "fire only after 2 steps of spray": [
        ("keep fire implies once (spray and previously once spray)", "if the steps may lie apart"),
        ("keep fire implies once (spray and previously spray)", "if they must follow one another"),
    ],
    "after fire no fire until spray or 5 s": [
        (
            "keep begins fire implies weak_next ((always for 5 s not begins fire) or "
            "(not begins fire weak_until spray))",
            "if steps in a row count once",
        ),
        (
            "keep fire implies weak_next ((always for 5 s not fire) or (not fire weak_until spray))",
            "if each step counts",
        ),
    ],
    "while fire, health never falls": NO_FALL_WHILE,
    "in fire, health never falls": NO_FALL_WHILE,
    "in fire, health stays the same": SAME_WHILE,
    "one fire per spray": ONE_PER,
    "fire once per spray": ONE_PER,
    "health above 10 in fire": [
        ("reach health > 10 and fire", "if it is a goal"),
        ("keep fire implies health > 10", "for each step with `fire`"),
    ],
    "fire twice while spray": [
        ("reach spray and times_since(fire, begins spray) >= 2", "if it is a goal, in one stretch with `spray`"),
        (
            "reach times((begins fire) and spray) >= 2",
            "if it is a goal, and all steps with `spray` count together",
        ),
        (
            "keep spray implies times_since(fire, begins spray) <= 2",
            "if no more are allowed in each stretch with `spray`",
        ),
    ],
    "when there is no fire for 8 s, spray within 2 s": ONCE_OR_ANEW,
    "when not fire for 8 s, spray within 2 s": ONCE_OR_ANEW,
    "spray within 2 s after not fire for 8 s or more": ONCE_OR_ANEW,
    "after fire no fire until spray or boss_dead": NOT_AGAIN_UNTIL,
    "after fire, no fire until spray or boss_dead": NOT_AGAIN_UNTIL,
    "after fire, no further fire until spray or boss_dead": NOT_AGAIN_UNTIL,
    "once fire, no fire before (spray or boss_dead)": NOT_AGAIN_UNTIL,
    "no second fire until spray or boss_dead": NOT_AGAIN_UNTIL,
    "no fire after fire until (spray or boss_dead)": NOT_AGAIN_UNTIL,
    "while fire keep health unchanged": SAME_WHILE,
    "keep health stays the same while fire": SAME_WHILE,
    "health does not change while fire": SAME_WHILE,
    "while fire keep coins unchanged": INT_SAME_WHILE,
    "coins does not change as long as fire": INT_SAME_WHILE,
    "while fire, coins and lap must not change": [
        (
            "keep fire and previously fire implies coins == previous(coins) and lap == previous(lap)",
            "within each `fire`",
        ),
        (
            "keep fire implies coins == previous(coins) and lap == previous(lap)",
            "also from the step before it begins",
        ),
    ],
    "phase stays the same while fire": [
        (
            "keep fire and previously fire implies not (ends (phase is menu) or ends (phase is shift) or "
            "ends (phase is results))",
            "within each `fire`",
        ),
        (
            "keep fire implies not (ends (phase is menu) or ends (phase is shift) or ends (phase is results))",
            "also from the step before it begins",
        ),
    ],
    "keep not fire for 2 s after spray": DENIED_AFTER,
    "after spray no fire for 2 s": DENIED_AFTER,
    "after phase is menu, no fire for 2 s": [
        ("keep phase is menu implies always for 2 s not fire", "from each step with `phase is menu` on"),
        ("keep ends (phase is menu) implies always for 2 s not fire", "from its end on"),
    ],
    "cooldown(fire, 2 s)": AGAIN,
    "fire has a cooldown of 2 s": AGAIN,
    "fire at most once every 2 s": APART,
    "at least 2 s between two fire": APART,
    "pause of 2 s between fire and the next fire": APART,
    "no two consecutive fire within 2 s": APART,
    "never fire twice within 2 s": APART,
    "fire must never happen twice within 2 s": APART,
    "fire must not happen more than once within 2 s": APART,
    "fire not more often than every 2 s": APART,
    "finally(coins >= 3 && fire)": [
        ("require eventually always (coins >= 3 and fire)", "if it must hold at the last step"),
        ("reach (coins >= 3 and fire)", "if once is enough"),
    ],
    "fire then spray in < 90s": [
        ("keep fire implies eventually within 90 s spray", "if it must follow each time"),
        ("reach fire then within 90 s spray", "if both are goals, and the time counts from `fire`"),
        ("require eventually within 90 s (spray and previously once fire)", "from the first step"),
    ],
    "if fire then spray until boss_dead": [
        ("keep fire implies (spray weak_until boss_dead)", "if play may end before `boss_dead`"),
        ("require (fire implies spray) weak_until boss_dead", "if the rule ends at `boss_dead`"),
        ("keep fire implies (spray until boss_dead)", "if `boss_dead` must come"),
    ],
    "if fire then not spray until boss_dead": [
        ("keep fire implies (not spray weak_until boss_dead)", "from each step with `fire` on"),
        ("require (fire implies not spray) weak_until boss_dead", "if the rule ends at `boss_dead`"),
    ],
    "fire must never go off": [
        ("avoid fire", "if `fire` must not come"),
        ("avoid ends fire", "if it must not end"),
    ],
    "count(fire) <= 2 until spray": [
        ("require times(fire) <= 2 weak_until spray", "if play may end before `spray`"),
        ("require times(fire) <= 2 until spray", "if `spray` must come"),
    ],
    "fire only if spray since boss_dead": [
        ("keep fire implies (spray since boss_dead)", ""),
        ("keep fire implies (not boss_dead since spray)", ""),
    ],
    "whenever fire becomes false then not spray within 5 s": [
        ("keep ends fire implies not eventually within 5 s spray", "if it must hold at no step of that time"),
        ("keep ends fire implies eventually within 5 s not spray", "if one step is enough"),
    ],
    "once fire keep fire until spray": [
        ("keep fire implies (fire weak_until spray)", "if play may end before `spray`"),
        ("keep fire implies (fire until spray)", "if `spray` must come"),
    ],
    "when health falls below 20 then fire until spray": [
        ("keep begins (health < 20) implies (fire weak_until spray)", "if play may end before `spray`"),
        ("keep begins (health < 20) implies (fire until spray)", "if `spray` must come"),
    ],
    "fire -> phase = menu until spray": [
        ("keep fire implies (phase is menu weak_until spray)", "if play may end before `spray`"),
        ("keep fire implies (phase is menu until spray)", "if `spray` must come"),
    ],
    "given fire when spray then boss_dead until coins > 3": [
        ("keep fire and spray implies (boss_dead weak_until coins > 3)", "if play may end before `coins > 3`"),
        ("keep fire and spray implies (boss_dead until coins > 3)", "if `coins > 3` must come"),
    ],
    "fire at least every 5 s": [
        ("keep time_holding(not fire) < 5 s", "if play may end in the middle of that time"),
        ("keep eventually within 5 s fire", "if `fire` must also hold at the last step"),
    ],
    "at least once every 5 steps fire happens": [
        (
            "avoid always for 5 steps not fire and next after 5 steps not fire",
            "if play may end in the middle of that time",
        ),
        ("keep eventually within 5 steps fire", "if `fire` must also hold at the last step"),
    ],
    "while spray, fire at least every 5 s": [
        ("keep time_holding(spray and not fire) < 5 s", "if play may end in the middle of that time"),
        (
            "keep spray implies eventually within 5 s (fire or not spray)",
            "if play must not end before `fire`",
        ),
    ],
    "after fire avoid fire for 3 s": [
        (
            "avoid (begins fire) then within 3 s (begins fire)",
            "if it may last, and must not begin again in that time",
        ),
        ("avoid fire then within 3 s fire", "if no step with it may follow in that time"),
        ("keep ends fire implies always for 3 s not fire", "if the time counts from its end"),
    ],
    "whenever fire ends, no fire for 3 s": [("keep ends fire implies always for 3 s not fire", "")],
    "no more than once fire within 5 s": [
        ("avoid (begins fire) then within 5 s (begins fire)", "if steps in a row count once"),
        ("avoid fire then within 5 s fire", "if each step counts"),
    ],
    "at least 5 s between two fire": [
        ("avoid (begins fire) then within 5 s (begins fire)", "if steps in a row count once"),
        ("avoid fire then within 5 s fire", "if each step counts"),
    ],
    "avoid fire for more than 3 s while spray": [
        ("avoid time_holding(fire and spray) > 3 s", "if the time counts only while `spray`"),
        ("avoid spray and time_holding(fire) > 3 s", "if `fire` may have begun before `spray`"),
    ],
    "at most one fire per spray": [
        ("keep times_since(fire, begins spray) <= 1", "if each `begins spray` begins a new count"),
        ("keep spray implies times_since(fire, begins spray) <= 1", "if it counts only while `spray` holds"),
    ],
    "keep times(fire) while spray <= 3": WHILE,
    "fire at most 3 times while spray": WHILE,
    "never more than 3 fire while spray": WHILE,
    "during spray, at most 3 fire": WHILE,
    "times(fire) <= 3 while spray": WHILE,
    "at most 3 fire in a spray": WHILE,
    "when fire twice, spray within 5 s": SEVERAL,
    "after 2 fire, spray within 5 s": SEVERAL,
    "at least 3 fire before spray": [
        ("keep spray implies times(fire) >= 3", "if it counts from the first step on"),
        (
            "keep begins spray implies previously (times_since(fire, begins spray) >= 3)",
            "if each `begins spray` begins a new count",
        ),
    ],
    "never lose more than 15 health in one fire": IN_ALL_OR_EACH,
    "lose at most 15 health per fire": IN_ALL_OR_EACH,
    "health must not drop by more than 15 in any fire": IN_ALL_OR_EACH,
    "never lose 20 health in one fire": [
        ("keep fire implies health > value_at(health, begins fire) - 20", "if it counts from where `fire` began"),
        ("keep fire implies health > previous(health) - 20", "for each step with `fire`"),
    ],
    "coins increases by at least 10 during each fire": [
        ("keep ends fire implies coins >= value_at(coins, begins fire) + 10", "if it counts from where `fire` began"),
        ("keep fire implies coins >= previous(coins) + 10", "for each step with `fire`"),
    ],
    "reach 3 fire within 30 s": [
        ("reach times_within(fire, 30 s) >= 3", "in any 30 s"),
        ("require eventually within 30 s times(fire) >= 3", "in the first 30 s of play"),
    ],
    "time spent in fire at most 30 s": [
        ("keep total_time(fire) <= 30 s", "for all stretches together"),
        ("keep time_holding(fire) <= 30 s", "for each stretch"),
    ],
    "fire at most 9 s in total during spray": [
        ("keep total_time(fire and spray) <= 9 s", "if all steps with `spray` count together"),
        (
            "keep spray implies total_time_since(fire, begins spray) <= 9 s",
            "if each `spray` counts anew",
        ),
    ],
    "fire for at most 9 s in each lap": [
        (
            "keep total_time_since(fire, lap != previous(lap)) <= 9 s",
            "if each `lap != previous(lap)` begins a new count",
        ),
        ("keep time_holding(fire) <= 9 s", "for each stretch with `fire`"),
    ],
    "not fire for at least 60 s in total": [
        ("reach total_time(not fire) >= 60 s", "for the time with `not fire`"),
        ("keep total_time(fire) < 60 s", "for that with `fire`"),
    ],
    "health falls by at most 15 during fire": IN_ALL_OR_EACH,
    "during fire, health falls by at most 15": IN_ALL_OR_EACH,
    "health must not fall by more than 15 during fire": IN_ALL_OR_EACH,
    "coins at least what it was when fire began": [
        ("keep fire implies coins >= value_at(coins, begins fire)", "for each step with `fire`"),
        ("keep ends fire implies coins >= value_at(coins, begins fire)", "if it is asked for where `fire` ends"),
        (
            "keep coins >= value_at(coins, begins fire)",
            "for every step, before the first event compared with the first step",
        ),
    ],
    "coins returns to what it was when fire began": [
        ("keep ends fire implies coins == value_at(coins, begins fire)", "if it is asked for where `fire` ends"),
        (
            "keep begins fire implies next eventually coins == value_at(coins, begins fire)",
            "if at some step after it began",
        ),
    ],
    "after fire keep coins >= coins at fire until spray": [
        (
            "keep fire implies (coins >= value_at(coins, begins fire) weak_until spray)",
            "if play may end before `spray`",
        ),
        ("keep fire implies (coins >= value_at(coins, begins fire) until spray)", "if `spray` must come"),
    ],
    "coins@fire - coins@spray >= 10": [
        ("keep begins fire implies coins - value_at(coins, begins spray) >= 10", "for each step with `begins fire`"),
        ("reach begins fire and coins - value_at(coins, begins spray) >= 10", "if it is a goal"),
    ],
    "after the fire, coins is the same as when fire began": [
        ("keep ends fire implies coins == value_at(coins, begins fire)", "for each step with `ends fire`"),
        ("keep ends fire implies always coins == value_at(coins, begins fire)", "if it holds from then on"),
    ],
    "reach fire then spray without boss_dead": [
        ("reach fire then spray", "avoid boss_dead", "if `boss_dead` must hold at no step of play"),
        (
            "reach fire and not boss_dead and next (not boss_dead until (spray and not boss_dead))",
            "if no step from `fire` to `spray` may have it, these two included",
        ),
        ("reach fire and next (not boss_dead until spray)", "if only no step between `fire` and `spray` may have it"),
    ],
    "reach fire then spray 2 times": [
        ("reach fire then begins spray then begins spray", "if steps in a row count once"),
        ("reach fire then spray then spray", "if each step counts"),
    ],
    "when fire starts, spray within 2 s then boss_dead until phase is menu": [
        (
            "keep begins fire implies eventually within 2 s (spray and (boss_dead weak_until phase is menu))",
            "if play may end before `phase is menu`",
        ),
        (
            "keep begins fire implies eventually within 2 s (spray and (boss_dead until phase is menu))",
            "if `phase is menu` must come",
        ),
    ],
    "fire while spray": [
        ("reach fire and spray", "if it is a goal"),
        ("keep spray implies fire", "for each step with `spray`"),
    ],
    "coins > 3 or fire": [("reach coins > 3 or fire", "if it is a goal"), ("keep coins > 3 or fire", "for every step")],
    "duration(fire) >= 3 s": [
        ("reach time_holding(fire) >= 3 s", "if it must last so long once"),
        ("keep begins fire implies always for 3 s fire", "if it must last so long each time"),
    ],
    "count(fire) >= 3": [
        ("reach times(fire) >= 3", "if it counts how often `fire` begins: no clause can count its steps"),
    ],
    "spray must end no later than 75 s": [
        ("avoid time_holding(spray) > 75 s", "for each time"),
        ("require eventually within 75 s not spray", "if the time counts from the first step"),
    ],
    "must hold coins == 1 for at least 10 s in a row": [
        ("reach time_holding(coins == 1) >= 10 s", "if once is enough"),
        ("keep begins coins == 1 implies always for 10 s coins == 1", "for each time"),
    ],
    "phase stays at shift for 3 s": [
        ("reach time_holding(phase is shift) >= 3 s", "if once is enough"),
        ("keep begins phase is shift implies always for 3 s phase is shift", "for each time"),
    ],
    "after phase == shift, 20 s of phase != shift": [
        (
            "avoid (begins phase is shift) then within 20 s (begins phase is shift)",
            "if it may last, and must not begin again in that time",
        ),
        ("avoid phase is shift then within 20 s phase is shift", "if no step with it may follow in that time"),
        ("keep ends phase is shift implies always for 20 s phase is not shift", "if the time counts from its end"),
    ],
    "coins only ever go up by one at a time": [
        ("keep coins == previous(coins) or coins == previous(coins) + 1", "if it never falls"),
        ("keep coins > previous(coins) implies coins == previous(coins) + 1", "if it may fall, too"),
    ],
    "when fire avoid spray": [
        ("avoid fire and spray", "for each step with `fire`"),
        ("keep fire implies always not spray", "if it holds from then on"),
    ],
}

NO_READING = (
    "avoid (fire unless spray)",  # an exception from what is forbidden is no `or`
    "never fire after spray unless boss_dead",  # once spray has been, or from its step on
    "never fire or spray when boss_dead unless coins > 3",
    "fire before spray unless boss_dead",
    "when fire, spray within 5 s and then stays stopped until boss_dead",  # which value means that it is stopped?
    "spray at least 5 s after fire",  # it lasts so long, or comes so late
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
    "every third fire must be spray": "no clause can say what holds at each third `fire`",
    "at some point health is 30 higher than 70 s ago": "no clause can say what `health` was 70 s ago",
    "health never falls by more than 5 in 70 s": "no clause says by how much `health` changes in 70 s",
    "when fire, spray after at least 1 s and at most 90 s": "a clause that looks 90 s ahead has too many states",
    "fire between 50 s and 80 s after spray": "a clause that looks 80 s ahead has too many states",
    "if spray then times(fire) <= 3 within 5 s": "`times(fire) <= 3` counts from the first step on",
    "at least 2 fire in any 5 s": "no short clause says that it is so often in each of them",
    "fire => coins@2s > coins": "no clause can say what `coins` is 2 s later or earlier",
}


def words_of_sentence(typed: str) -> Words:
    source = SourceFile("a.tltl", f"{HEAD}spec s {{\n{typed}\n}}\n")
    start = len(HEAD) + len("spec s {\n")
    tokens = [token for token in tokenize(source.text).tokens if start <= token.start < token.end <= start + len(typed)]
    return with_own_calls(words_of(source, declared_names(source), tokens, ENGLISH))


def read(typed: str) -> Sentence:
    return sentence(words_of_sentence(typed))


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


@pytest.mark.parametrize(
    "typed", ["phase: menu -> shift -> results -> menu", "phase must go from menu to shift to results to menu"]
)
def test_an_order_of_values_is_a_goal_or_a_rule(typed: str) -> None:
    goal, rule = read(typed).readings
    assert goal.clauses == ("reach phase is menu then phase is shift then phase is results then phase is menu",)
    assert rule.clauses == (
        "keep phase is menu implies weak_next (phase is menu or phase is shift)",
        "keep phase is shift implies weak_next (phase is shift or phase is results)",
        "keep phase is results implies weak_next (phase is results or phase is menu)",
    )


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
