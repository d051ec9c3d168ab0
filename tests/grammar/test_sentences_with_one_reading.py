"""Sentences of designers mean the clauses that the grammar of sentences reads from them."""

from __future__ import annotations

import pytest

import tltlc
from tests.grammar.sentences import HEAD, VARIES, read

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


@pytest.mark.parametrize("typed", ONE_READING)
def test_a_sentence_has_the_reading(typed: str) -> None:
    (reading,) = read(typed).readings
    assert list(reading.clauses) == ONE_READING[typed]
    tltlc.compile_text(f"{HEAD}spec s {{\n{chr(10).join(reading.clauses)}\n}}\n")
