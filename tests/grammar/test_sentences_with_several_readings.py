"""Sentences that may mean several things get each of them, with what tells them apart."""

from __future__ import annotations

import pytest

from tests.grammar.sentences import read
from tltlc.grammar.mistakes.sentences.validity import is_valid

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
            "if no step from one with `fire` to `boss_dead` may have it, these two included",
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
            "if no step from one with `fire` to `spray` may have it, these two included",
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
