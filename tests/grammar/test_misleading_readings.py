"""Sentences whose first reading would mislead get the others, and no clause that no trace can meet."""

from __future__ import annotations

import pytest

from tests.grammar.phrases_as_typed import errors
from tests.grammar.sentences import HEAD
from tltlc import compile_text
from tltlc.core.source import SourceFile
from tltlc.grammar.english.contradictions import forbids_its_event
from tltlc.grammar.mistakes.sentences.validity import is_valid
from tltlc.monitor import Monitor

HELPS = {
    "keep begins fire and phase is menu implies not fire before phase is shift": (
        "write `keep begins fire and phase is menu implies (phase is not shift weak_until not fire)` "
        "if `not fire` must come before `phase is shift`, or with it, "
        "or `keep begins fire and phase is menu implies weak_next (not fire weak_until phase is shift)` "
        "if `fire` must not hold again before `phase is shift`"
    ),
    "keep times(fire) <= 2 between spray and spray": "write `keep times_since(fire, spray) <= 2`",
    "keep times(fire) <= 2 between spray and the next spray": "write `keep times_since(fire, spray) <= 2`",
    "keep times(fire) <= 2 between spray and boss_dead": (
        "write `keep (not boss_dead since begins spray) implies times_since(fire, begins spray) <= 2`"
    ),
    "keep fire implies spray and ends spray within 1 s": (
        "write `keep fire implies spray and eventually within 1 s ends spray`"
    ),
    "keep fire implies once in the last 60 s spray": "write `keep fire implies once within 60 s spray`",
    "keep fire never twice in a row without spray": "write `keep times_since(fire, spray) <= 1`",
    "keep fire implies boss_dead at most twice": (
        "write `keep fire implies times(boss_dead) <= 2` if the count begins with the first step, "
        "or `keep fire implies times_since(boss_dead, begins fire) <= 2` if each `fire` begins a new count, "
        "or `keep times((begins boss_dead) and fire) <= 2` if all steps with `fire` count together"
    ),
    "keep fire implies spray and boss_dead at most once": (
        "write `keep fire implies spray` and `keep fire implies times(boss_dead) <= 1` "
        "if the count begins with the first step, or `keep fire implies spray` and "
        "`keep fire implies times_since(boss_dead, begins fire) <= 1` if each `fire` begins a new count, "
        "or `keep fire implies spray` and `keep times((begins boss_dead) and fire) <= 1` "
        "if all steps with `fire` count together"
    ),
    "keep at most 5 fire and lap >= 2": (
        "write `keep times(fire and lap >= 2) <= 5`, or `keep times(fire) <= 5` and `keep lap >= 2` "
        "if `lap >= 2` must hold at every step"
    ),
    # A time that looks ahead or back.
    "keep begins fire implies spray for at least 2 s": (
        "write `keep begins fire implies always for 2 s spray`, or "
        "`keep begins fire implies time_holding(spray) >= 2 s` if `spray` must have held for so long by then"
    ),
    "keep begins fire implies spray for at least 20 steps": (
        "write `keep begins fire implies always for 20 steps spray`, or "
        "`keep begins fire implies historically for 20 steps spray` if `spray` must have held for so long by then"
    ),
    "whenever spray starts, keep spray for at least 2 s": "write `keep begins spray implies always for 2 s spray`",
    "keep spray while fire and for 3 s after": "write `keep once within 3 s fire implies spray`",
    "require not fire until within 3 s spray": (
        "write `require eventually within 3 s spray` and `require not fire until spray`"
    ),
    "keep begins fire implies not fire before begins phase is shift": (
        "write `keep begins fire implies (not begins (phase is shift) weak_until not fire)` "
        "if `not fire` must come before `begins (phase is shift)`, or with it, or "
        "`keep begins fire implies weak_next (not begins fire weak_until begins (phase is shift))` "
        "if `fire` must not begin again before `begins (phase is shift)`"
    ),
    "never more than one of fire, spray and boss_dead": (
        "write `avoid fire and spray` and `avoid fire and boss_dead` and `avoid spray and boss_dead`"
    ),
    "at most one of fire, spray and boss_dead at a time": (
        "write `avoid fire and spray` and `avoid fire and boss_dead` and `avoid spray and boss_dead`"
    ),
    # Rules of a tester's corpus.
    "avoid second fire": "write `keep times(fire) <= 1`",
    "keep spray when health > 80 except when fire": "write `keep health > 80 and not fire implies spray`",
    "avoid health > 50 for 3 steps in a row": (
        "write `avoid always for 2 steps health > 50 and next after 2 steps health > 50`"
    ),
    "every fire is out within 1 min": "write `avoid time_holding(fire) > 1 min`",
    "keep phase changes from shift only to results": "write `keep ends (phase is shift) implies phase is results`",
    "health never less than 80% of max health": "write `keep health >= 0.8 * highest(health)`",
    "keep health >= half of health 30 s ago": "write `keep health >= previous(health, 30 s) / 2`",
    "fire before second spray": "write `keep begins (times(spray) >= 2) implies once fire`",
    "coins never drops more than 30 in one step": "write `keep coins >= previous(coins) - 30`",
    "reach lap == 2 and health >= 50 all the time until then": "write `require health >= 50 until lap == 2`",
    "when phase is menu coins resets to 0": "write `keep phase is menu implies coins == 0`",
    "lap never goes from 0 to 2": "write `avoid previously (lap == 0) and lap == 2`",
    "reach 3 times coins increases without fire": (
        "write `require not fire until times(coins > previous(coins)) >= 3` if `fire` must not come before the last "
        "of them, or `reach times_since(coins > previous(coins), fire) >= 3` if `fire` must not come between them, "
        "or `reach times(coins > previous(coins)) >= 3` and `avoid fire` if `fire` must never come"
    ),
    "reach coins >= 10 twice": "write `reach times(coins >= 10) >= 2`",
    "after fire wait 3 s before spray": "write `keep fire implies always for 3 s not spray`",
    "no spray in the 3 s before fire": "write `keep begins fire implies not once within 3 s spray`",
    "phase never menu twice": "write `keep times(phase is menu) <= 1`",
    "never fire in phase menu unless spray in the last 2 s": (
        "write `keep fire and phase is menu implies once within 2 s spray`"
    ),
    "fire and spray alternate": (
        "write `keep times_since(fire, begins spray) <= 1` and `keep times_since(spray, begins fire) <= 1`"
    ),
    "the time between fire and spray is at most 5 s": (
        "write `keep begins fire implies eventually within 5 s spray` from each `fire` to a later `spray`"
    ),
    "keep begins fire implies once at least 30 s ago spray": (
        "write `keep begins fire implies time_holding(once spray) >= 30 s`"
    ),
    "finish fire and coins >= 20": (
        "write `require eventually always (fire and coins >= 20)` if it must hold at the last step, "
        "or `reach fire and coins >= 20` if once is enough"
    ),
    "reach (fire, spray, boss_dead) in any order then coins > 3": (
        "write `reach fire then coins > 3` and `reach spray then coins > 3` and `reach boss_dead then coins > 3`"
    ),
    "when fire 3 times in phase is shift then spray within 1 min": (
        "write `keep begins (phase is shift and times_since(fire, begins phase is shift) >= 3) "
        "implies eventually within 1 min spray`"
    ),
    "keep fire implies no spray and no fire for the next 10 s": (
        "write `keep fire implies always for 10 s not spray` and "
        "`avoid (begins fire) then within 10 s (begins fire)` if the time is for both"
    ),
    "keep fire for at most 3 s then not fire for 20 s": (
        "write `avoid time_holding(fire) > 3 s` and `keep ends fire implies always for 20 s not fire`"
    ),
    "phase must be shift within 20 s of the start": "write `require eventually within 20 s phase is shift`",
    "spray can only start if fire was true in the previous 3 s": (
        "write `keep begins spray implies once within 3 s fire`"
    ),
    "no fire while spray or within 2 s after spray": "write `keep once within 2 s spray implies not fire`",
    # What denies itself, or is denied.
    "after fire, wait 3 s before fire": (
        "write `avoid (begins fire) then within 3 s (begins fire)` "
        "if it may last, and must not begin again in that time, "
        "or `avoid fire then within 3 s fire` if no step with it may follow in that time, "
        "or `keep ends fire implies always for 3 s not fire` if the time counts from its end"
    ),
    "phase is never shift more than twice": "write `keep times(phase is shift) <= 2`",
    "phase is never menu for at least 3 s": "write `avoid time_holding(phase is menu) >= 3 s`",
    "when fire, phase is never menu or shift": (
        "write `avoid fire and (phase is menu or phase is shift)` for each step with `fire`, "
        "or `keep fire implies always not (phase is menu or phase is shift)` if it holds from then on"
    ),
    "in the first 5 s, no fire": "write `require always for 5 s not fire`",
    "when fire is out, spray": "write `keep not fire implies spray`",
    "fire is gone within 5 s": "write `require eventually within 5 s not fire`",
    "finish with lap == 3 and no fire": (
        "write `require eventually always (lap == 3 and not fire)` if all of it is about the last step, "
        "or `require eventually always lap == 3` and `avoid fire` if `fire` must never hold"
    ),
    "fire or spray but never both": (
        "write `reach fire or spray` and `avoid fire and spray` if both must never hold together, "
        "or `keep fire iff not spray` if one of them must hold at every step"
    ),
    "reach fire, spray or boss_dead then lap == 3": (
        "write `and`, `or` or `then` instead, and put brackets around what belongs together"
    ),
    "reach fire and coins >= 1, spray and coins >= 2, boss_dead in any order": (
        "write `reach fire and coins >= 1` and `reach spray and coins >= 2` and `reach boss_dead`"
    ),
    "fire is out for at most 3 s": "write `avoid time_holding(not fire) > 3 s`",
    # Numbers that come to a value, and parts of numbers.
    "when coins is reset to 0, spray": "write `keep begins coins == 0 implies spray`",
    "when lap becomes 3, spray": "write `keep begins lap == 3 implies spray`",
    "health gets to 0 within 5 s": "write `require eventually within 5 s health <= 0`",
    "health gets to 50 within 5 s": (
        "write `require eventually within 5 s health >= 50` if `health` comes to it from below, "
        "or `require eventually within 5 s health <= 50` if `health` comes to it from above"
    ),
    "keep health / twice lap <= 1": "write `keep health / (2 * lap) <= 1`",
    # What is denied twice, and what holds at the end.
    "no spray and no boss_dead until fire": "write `require not (spray or boss_dead) weak_until fire`",
    "no spray or no boss_dead before fire": "write `require not (spray or boss_dead) weak_until fire`",
    "keep fire implies no spray and no boss_dead until phase is menu": (
        "write `keep fire implies (not (spray or boss_dead) weak_until phase is menu)`"
    ),
    "require health > initial(health) at the end": "write `require eventually always health > initial(health)`",
    "while spray or boss_dead, fire at least every 5 s": (
        "write `keep time_holding((spray or boss_dead) and not fire) < 5 s` "
        "if play may end in the middle of that time, "
        "or `keep spray or boss_dead implies eventually within 5 s (fire or not (spray or boss_dead))` "
        "if play must not end before `fire`"
    ),
    "fire must be followed by spray before the next fire": "write `keep times_since(fire, begins spray) <= 1`",
    "keep fire implies spray or boss_dead at least every 10 s": (
        "write `keep time_holding(fire and not (spray or boss_dead)) < 10 s` "
        "if play may end in the middle of that time, "
        "or `keep fire implies eventually within 10 s (spray or boss_dead or not fire)` "
        "if play must not end before `spray or boss_dead`"
    ),
    # Values of the step before, or of some time ago.
    "keep fire implies coins and lap unchanged": (
        "write `keep fire and previously fire implies coins == previous(coins) and lap == previous(lap)` "
        "within each `fire`, or `keep fire implies coins == previous(coins) and lap == previous(lap)` "
        "also from the step before it begins"
    ),
    "keep fire implies health does not fall": (
        "write `keep fire and previously fire implies health >= previous(health)` within each `fire`, "
        "or `keep fire implies health >= previous(health)` also from the step before it begins"
    ),
    "coins must not drop by more than 3 within 1 s": "write `keep coins >= highest_within(coins, 1 s) - 3`",
    "coins rises by at most 3 in any 2 s": "write `keep coins <= lowest_within(coins, 2 s) + 3`",
    "keep coins >= highest coins in the last 5 s - 3": "write `keep coins >= highest_within(coins, 5 s) - 3`",
    "whenever fire, coins rises by at least 3 within 0.3 s": (
        "write `keep begins fire implies eventually within 0.3 s coins >= value_at(coins, begins fire) + 3` "
        "if it is compared with its value at `begins fire`, "
        "or `keep begins fire implies eventually within 0.3 s coins >= value_at(previous(coins), begins fire) + 3` "
        "if it is compared with its value at the step before, "
        "or `keep fire implies eventually within 0.3 s coins >= previous(coins) + 3` "
        "if it must change so much from one step to the next"
    ),
    "keep coins at most twice lap": "write `keep coins <= 2 * lap`",
    # The first, the second and further ones.
    "fire within 60 s after the first spray": "write `keep begins (once spray) implies eventually within 60 s fire`",
    "when fire first happens, coins == 0": "write `keep begins (once fire) implies coins == 0`",
    "at the first fire, coins is 0": "write `keep begins (once fire) implies coins == 0`",
    "after the second spray, no fire": "write `keep begins (times(spray) >= 2) implies always not fire`",
    "no fire until the third spray": "write `require not fire weak_until begins (times(spray) >= 3)`",
    "fire only after the second spray": "write `keep fire implies times(spray) >= 2`",
    # Several conditions, and several times.
    "while phase is menu, never fire, spray or boss_dead": (
        "write `keep phase is menu implies not (fire or spray or boss_dead)`"
    ),
    "when phase is menu, no fire, no spray and no boss_dead": (
        "write `keep phase is menu implies not fire and not spray and not boss_dead`"
    ),
    "keep begins fire implies fire for at least 2 s and at most 4 s": (
        "write `keep begins fire implies always for 2 s fire` and "
        "`keep begins fire implies eventually within 4 s not fire`"
    ),
    "keep fire implies spray at least every 10 s": (
        "write `keep time_holding(fire and not spray) < 10 s` if play may end in the middle of that time, "
        "or `keep fire implies eventually within 10 s (spray or not fire)` if play must not end before `spray`"
    ),
    "keep coins >= coins 1 s ago - 3": "write `keep coins >= previous(coins, 1 s) - 3`",
    "health is never below 20 for more than 10 s": "write `avoid time_holding(health < 20) > 10 s`",
}


@pytest.mark.parametrize("typed", HELPS)
def test_the_help_has_the_readings(typed: str) -> None:
    left = errors(SourceFile("a.tltl", f"{HEAD}spec s {{\n{typed}\n}}\n"))
    assert [(error.help or "").splitlines()[0] for error in left] == [HELPS[typed]]


def test_at_least_every_says_how_far_apart_two_may_be() -> None:
    (error,) = errors(SourceFile("a.tltl", f"{HEAD}spec s {{\nspray at least every 6 s\n}}\n"))
    note = "it counts from the step after each: two may be 6.1 s apart; write `< 5.9 s` if 6 s is the most"
    assert (error.help or "").splitlines()[1:] == [note]
    for time, most in (("6 s", 61), ("5.9 s", 60)):
        (fspa,) = compile_text(f"clock 10 Hz\nsignal spray: bool\nspec s {{ keep time_holding(not spray) < {time} }}")
        for steps, is_kept in ((most, True), (most + 1, False)):
            monitor = Monitor(fspa)
            verdicts = [monitor.step({"spray": step in (0, steps)}).verdict for step in range(steps + 1)]
            assert ("violated" not in verdicts) == is_kept


def test_two_events_so_far_apart_are_said_to_be_forbidden() -> None:
    (error,) = errors(SourceFile("a.tltl", f"{HEAD}spec s {{\nat least 3 s between two begins fire\n}}\n"))
    note = "3 s after the first is forbidden, too: write 2.9 s if it is allowed"
    assert (error.help or "").splitlines()[1:] == [note]
    for time, is_kept in (("3 s", False), ("2.9 s", True)):
        rule = f"avoid (begins fire) then within {time} (begins fire)"
        (fspa,) = compile_text(f"clock 10 Hz\nsignal fire: bool\nspec s {{ {rule} }}")
        monitor = Monitor(fspa)
        verdicts = [monitor.step({"fire": step in (1, 31)}).verdict for step in range(40)]
        assert ("violated" not in verdicts) == is_kept


@pytest.mark.parametrize(
    "typed",
    [
        "after the first fire, no fire for 5 s",
        "after the second fire, no fire",
        "no fire before the second fire",
        "fire only after the second fire",
        "keep ends fire implies fire for at least 2 s",
    ],
)
def test_no_help_forbids_what_the_sentence_speaks_of(typed: str) -> None:
    for error in errors(SourceFile("a.tltl", f"{HEAD}spec s {{\n{typed}\n}}\n")):
        offered = [text for text in (error.help or "").split("`")[1::2] if is_valid((text,))]
        assert not forbids_its_event(offered)
