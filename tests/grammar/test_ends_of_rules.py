"""The ends of rules: `unless c` and `while c` behind any answer, and other parts that any rule may have."""

from __future__ import annotations

import pytest

from tests.grammar.phrases_as_typed import errors
from tests.grammar.sentences import read, spec

Readings = list[tuple[str, ...]]
FIRST = "if `boss_dead` counts only at the first step of that time"
EACH = "if it excuses the steps with `boss_dead` alone"
ENOUGH = "if `boss_dead` in that time is enough"

UNLESS: dict[str, Readings] = {
    "keep ends fire implies no spray for 4 s unless boss_dead": [
        (
            "keep ends fire implies (always for 4 s not spray) or (not spray until boss_dead)",
            "if `boss_dead` ends that time",
        ),
        ("keep ends fire implies boss_dead or (always for 4 s not spray)", FIRST),
        ("keep ends fire implies always for 4 s (not spray or boss_dead)", EACH),
    ],
    "keep fire implies weak_next always for 1 s health >= previous(health) unless boss_dead": [
        ("keep fire implies boss_dead or (weak_next always for 1 s health >= previous(health))", FIRST),
        ("keep fire implies weak_next always for 1 s (health >= previous(health) or boss_dead)", EACH),
    ],
    "keep begins fire while phase is menu implies spray within 1 s unless boss_dead": [
        ("keep begins fire and phase is menu implies boss_dead or (eventually within 1 s spray)", FIRST),
        ("keep begins fire and phase is menu implies eventually within 1 s (spray or boss_dead)", ENOUGH),
    ],
    "spray within 2 s after fire unless boss_dead comes first": [
        ("keep fire implies eventually within 2 s (spray or boss_dead)", ""),
    ],
    "keep fire implies no spray until lap == 3 unless boss_dead": [
        ("keep fire implies (not spray weak_until (lap == 3 or boss_dead))", "if `boss_dead` ends it, too"),
    ],
    "keep time_holding(fire) >= 1 s implies eventually within 0.5 s spray unless boss_dead": [
        ("keep begins (time_holding(fire) >= 1 s) implies boss_dead or (eventually within 0.5 s spray)", FIRST),
        (
            "keep begins (time_holding(fire) >= 1 s) implies eventually within 0.5 s (spray or boss_dead)",
            f"{ENOUGH}, and once each time that this begins",
        ),
        (
            "keep time_holding(fire) >= 1 s implies eventually within 0.5 s (spray or boss_dead)",
            f"{ENOUGH}, and anew at each step while it lasts",
        ),
    ],
}
WHILE: dict[str, Readings] = {
    "when fire, spray within 3 s while phase is menu": [
        (
            "keep fire and phase is menu implies eventually within 3 s spray",
            "if `phase is menu` counts at the step of `fire`",
        ),
        (
            "keep fire and phase is menu implies eventually within 3 s (spray or phase is not menu)",
            "if nothing is asked for once `phase is menu` is over",
        ),
    ],
    "keep fire implies spray while phase is menu": [("keep fire and phase is menu implies spray", "")],
    "spray when fire while phase is menu": [("keep fire and phase is menu implies spray", "")],
    "keep lap never falls and never rises by more than 1 while phase is shift": [
        (
            "keep phase is shift and previously phase is shift implies "
            "lap >= previous(lap) and lap <= previous(lap) + 1",
            "within each `phase is shift`",
        ),
        (
            "keep phase is shift implies lap >= previous(lap) and lap <= previous(lap) + 1",
            "also from the step before it begins",
        ),
    ],
}
OTHERS: dict[str, Readings] = {
    "keep begins fire implies not spray until 2 s after boss_dead": [
        (
            "keep begins fire implies (not spray weak_until (boss_dead and always for 2 s not spray))",
            "if play may end before `boss_dead`",
        ),
        (
            "keep begins fire implies (not spray until (boss_dead and always for 2 s not spray))",
            "if `boss_dead` must come",
        ),
    ],
    "after begins fire, at most one spray before boss_dead": [
        ("keep (not boss_dead since begins fire) implies times_since(spray, begins fire) <= 1", ""),
    ],
    "keep fire implies within 20 s (spray then boss_dead)": [
        (
            "keep begins fire implies eventually within 20 s (boss_dead and not begins fire and "
            "previously (not begins fire since spray))",
            "if the time counts from where `fire` begins, anew from each",
        ),
        (
            "keep begins fire implies eventually (spray and eventually within 20 s boss_dead)",
            "if it counts from `spray`",
        ),
    ],
    "reach fire then spray before lap == 2": [
        (
            "require lap != 2 until (spray and previously once fire and lap != 2)",
            "if all of them must come before `lap == 2`",
        ),
        (
            "require lap != 2 weak_until (spray and previously once fire)",
            "if none of them need come, but `lap == 2` not before",
        ),
    ],
    "every third fire is followed by spray within 5 s": [
        (
            "keep begins fire and (times(fire) == 3 or times(fire) == 6 or times(fire) == 9) implies "
            "eventually within 5 s spray",
            "up to number 9: no clause counts for ever",
        ),
    ],
    "health falls by at least 30 %": [("keep health <= 0.7 * previous(health)", "")],
    "health never falls by more than 50 %": [("keep health >= 0.5 * previous(health)", "")],
    "keep spray for 1 s before fire": [
        ("keep begins fire implies previously time_holding(spray) >= 1 s", ""),
    ],
    "fire at least half of the time": [
        (
            "require eventually always total_time(fire, 10 min) >= 0.5 * total_time(true, 10 min)",
            "if it counts when play ends, and no play is longer than 10 min",
        ),
        (
            "keep total_time(fire, 10 min) >= 0.5 * total_time(true, 10 min)",
            "if it must be so at each step, and no play is longer than 10 min",
        ),
    ],
    "keep fire implies coins >= 50 and never spray": [
        ("keep fire implies coins >= 50 and not once spray", "if no `spray` may have come up to that step"),
        ("keep fire implies coins >= 50 and always not spray", "if no `spray` may come from that step on"),
    ],
    "coins must reach 50 within 60 s": [
        ("require eventually within 60 s coins >= 50", "if `coins` comes to it from below"),
        ("require eventually within 60 s coins <= 50", "if `coins` comes to it from above"),
    ],
    "lap must reach 3 before boss_dead": [
        ("require not boss_dead until lap >= 3", "if `lap` comes to it from below"),
        ("require not boss_dead until lap <= 3", "if `lap` comes to it from above"),
    ],
    "fire is never twice": [("keep times(fire) <= 1", "")],
    "when fire, spray within 1 s and boss_dead within 3 s": [
        ("keep fire implies eventually within 1 s spray", "keep fire implies eventually within 3 s boss_dead", ""),
    ],
    "when fire, spray for at least 2 s and at most 4 s": [
        (
            "keep begins fire implies always for 2 s spray",
            "keep begins fire implies eventually within 4 s not spray",
            "",
        ),
    ],
    "keep begins fire implies not spray after 1 s": [
        (
            "keep ends (once within 9 steps begins fire) implies not spray",
            "if it must hold 1 s after the last `begins fire`, at that step",
        ),
        ("keep begins fire implies eventually within 1 s not spray", "if it may come earlier, at most 1 s later"),
        (
            "keep once begins fire and time_since(begins fire) >= 1 s implies not spray",
            "if it must hold from then on, up to the next `begins fire`",
        ),
    ],
    "keep ends fire implies time_holding(fire) was >= 6 s": [
        ("keep ends fire implies previously (time_holding(fire) >= 6 s)", ""),
    ],
    "keep fire implies lap >= 3 and no spray since boss_dead": [
        ("keep fire implies lap >= 3 and (not spray since boss_dead)", ""),
    ],
    "after fire, coins never falls for 1 s": [
        ("keep fire implies weak_next always for 1 s coins >= previous(coins)", "from the step after `fire` on"),
        (
            "keep fire implies always for 1 s coins >= previous(coins)",
            "from the step of `fire` on, which is then compared with the step before it",
        ),
    ],
    "keep lap == 0 if fire or no spray for 1.5 s": [
        ("keep fire or time_holding(not spray) >= 1.5 s implies lap == 0", ""),
    ],
    "keep fire for 3 s while phase is shift implies spray": [
        (
            "keep time_holding(fire and phase is shift) >= 3 s implies spray",
            "if `phase is shift` must hold all that time",
        ),
        (
            "keep time_holding(fire) >= 3 s and phase is shift implies spray",
            "if `phase is shift` must hold at the end of that time alone",
        ),
    ],
    "when health == 0 then spray is false within 1 s until boss_dead": [
        (
            "keep health <= 0 implies eventually within 1 s (not spray and (not spray weak_until boss_dead))",
            "if play may end before `boss_dead`",
        ),
        (
            "keep health <= 0 implies eventually within 1 s (not spray and (not spray until boss_dead))",
            "if `boss_dead` must come",
        ),
    ],
    "keep begins fire implies spray at least 30 s before": [
        (
            "keep begins fire implies once spray and time_since(spray) >= 30 s",
            "if the last `spray` must be so long ago",
        ),
        ("keep begins fire implies time_holding(once spray) >= 30 s", "if an earlier one counts, too"),
    ],
    "keep boss_dead implies never not fire for more than 15 s except during spray": [
        (
            "avoid time_holding(boss_dead and not fire and not spray) > 15 s",
            "if time without `boss_dead` does not count",
        ),
        ("keep boss_dead implies not time_holding(not fire and not spray) > 15 s", "if it does"),
    ],
    "keep begins fire implies spray since the last fire": [
        ("keep begins fire implies previously (not fire since (spray and not fire))", ""),
    ],
    "keep health >= highest_within(health, 0.5 s) - 2 unless fire within the last 1 s": [
        ("keep health >= highest_within(health, 0.5 s) - 2 or once within 1 s fire", ""),
    ],
    "reach (fire then spray) 2 times then boss_dead": [
        ("reach fire then spray then fire then spray then boss_dead", "")
    ],
    "while boss_dead, keep fire only if spray or coins > 3": [
        ("keep boss_dead and fire implies spray or coins > 3", ""),
    ],
    "keep begins fire implies exactly one spray within 1 s": [
        (
            "keep begins fire implies eventually within 1 s begins spray",
            "keep once within 1 s begins fire implies times_since(spray, begins fire) <= 1",
            "",
        ),
    ],
    "keep begins fire implies spray for at least 1 s and at most 4 s unless boss_dead": [
        (
            "keep begins fire implies (always for 1 s spray) or (spray until boss_dead)",
            "keep begins fire implies eventually within 4 s not spray",
            "",
        ),
    ],
    "when fire and no spray for 5 s, boss_dead": [
        ("keep fire and time_holding(not spray) >= 5 s implies boss_dead", ""),
    ],
    "keep coins > previous(coins) implies coins <= previous(coins) for the last 1 s": [
        ("keep coins > previous(coins) implies previously time_holding(coins <= previous(coins)) >= 1 s", ""),
    ],
}


def test_a_help_leaves_no_part_of_a_condition_as_a_clause_of_its_own() -> None:
    (error,) = errors(spec("keep fire and no spray for 2 s implies boss_dead"))
    assert (error.help or "").startswith("write `keep fire and time_holding(not spray) >= 2 s implies boss_dead`")


@pytest.mark.parametrize(("typed", "readings"), [*UNLESS.items(), *WHILE.items(), *OTHERS.items()])
def test_a_rule_has_the_readings(typed: str, readings: Readings) -> None:
    assert [(*reading.clauses, reading.condition) for reading in read(typed).readings] == readings
