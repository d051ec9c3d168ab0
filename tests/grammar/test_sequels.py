"""Sentences that say what comes first, what must come again, and what comes since an event, mean what they say."""

from __future__ import annotations

import pytest

from tests.grammar.phrases_as_typed import errors
from tests.grammar.sentences import read, spec
from tltlc import compile_text
from tltlc.grammar.mistakes.sentences.validity import is_valid
from tltlc.monitor import Monitor

IN_ORDER_WITHIN_5_S = [
    (
        "require eventually within 5 s (boss_dead and previously once (spray and previously once fire))",
        "if the time is for all of them, from the first step of play on",
    ),
    (
        "reach fire then spray then (boss_dead and once within 5 s begins fire)",
        "if it is for all of them, from where `fire` begins, the last time if it begins again",
    ),
    ("reach fire then begins spray then within 5 s boss_dead", "if it counts from where `spray` begins"),
    (
        "reach fire then spray then within 5 s boss_dead",
        "if it counts from any step with `spray`, such as the last",
    ),
]
"""From when a time at the end of a sequence may count."""
ONE_READING = {
    "keep after begins fire, spray or not fire within 30 s": [
        "keep begins fire implies eventually within 30 s (spray or not fire)"
    ],
    "keep whenever begins fire spray within 30 s": ["keep begins fire implies eventually within 30 s spray"],
    "keep fire implies spray since the last fire": [
        "keep fire implies previously (not fire since (spray and not fire))"
    ],
    "each fire needs a spray since the fire before": [
        "keep fire implies previously (not fire since (spray and not fire))"
    ],
    "keep fire implies phase is menu since the previous fire": [
        "keep fire implies previously (not fire since (phase is menu and not fire))"
    ],
    "fire needs spray since last fire": ["keep fire implies previously (not fire since (spray and not fire))"],
    "no fire without spray since last fire": ["keep fire implies previously (not fire since (spray and not fire))"],
    "when fire, eventually spray before boss_dead": ["keep begins fire implies (not boss_dead until spray)"],
    "when fire, no spray before boss_dead": ["keep fire implies (not spray weak_until boss_dead)"],
    "when fire, not spray before boss_dead": ["keep fire implies (not spray weak_until boss_dead)"],
    "when boss_dead, no fire and no spray": ["keep boss_dead implies not fire and not spray"],
    "from fire on, no spray": ["keep fire implies always not spray"],
    "keep when time_holding(fire) == 3 s, spray": ["keep begins (time_holding(fire) >= 3 s) implies spray"],
    "keep fire before spray implies boss_dead": ["keep spray and previously once fire implies boss_dead"],
    "when fire, never spray unless boss_dead": ["keep fire implies not spray or boss_dead"],
}

EARLIER = "asked where the condition begins"
ANEW = "asked anew at each step with the condition"
BEFORE = [
    (
        "keep begins fire implies (not boss_dead weak_until spray)",
        f"if `spray` must come before `boss_dead` or at the same step, and neither need come; {EARLIER}",
    ),
    (
        "keep begins fire implies (not boss_dead until spray)",
        f"if `spray` must come, before `boss_dead` or at the same step; {EARLIER}",
    ),
    (
        "keep fire implies (not boss_dead weak_until spray)",
        f"if `spray` must come before `boss_dead` or at the same step, and neither need come; {ANEW}",
    ),
    (
        "keep fire implies (not boss_dead until (spray and not boss_dead))",
        f"if `spray` must come, at an earlier step than `boss_dead`; {ANEW}",
    ),
]
BEFORE_FROM_EDGE = [
    *BEFORE[:2],
    (
        "keep begins fire implies (not boss_dead until (spray and not boss_dead))",
        f"if `spray` must come, at an earlier step than `boss_dead`; {ANEW}",
    ),
]
SEVERAL_READINGS = {
    "fire implies spray before boss_dead": BEFORE,
    "keep begins fire implies spray before ends fire": [
        (clause.replace("boss_dead", "ends fire"), condition.replace("boss_dead", "ends fire"))
        for clause, condition in BEFORE_FROM_EDGE
    ],
    "when fire, spray before boss_dead": BEFORE,
    "spray before boss_dead once fire begins": BEFORE_FROM_EDGE,
    "each fire needs spray before boss_dead": BEFORE,
    "when fire begins, spray before boss_dead within 3 s": [
        (
            "keep begins fire implies (not boss_dead until spray) and eventually within 3 s spray",
            "if `spray` must come within 3 s, and `boss_dead` not before it",
        ),
        (
            "keep begins fire implies (always for 3 s not boss_dead) or (not boss_dead until spray)",
            "if neither need come",
        ),
    ],
    "when fire, spray only after boss_dead": [
        ("keep begins fire implies (not spray weak_until boss_dead)", "if `boss_dead` must come after the condition"),
        ("keep fire implies (not spray or once boss_dead)", "if `boss_dead` may have come before the condition"),
    ],
    "keep fire before spray implies boss_dead before phase is menu": [
        (
            "require (not spray until fire) implies (phase is not menu weak_until boss_dead)",
            "if `fire` comes before the first `spray` of play, and then `boss_dead` must "
            "come before `phase is menu` in all of play",
        ),
        (
            "keep begins spray and previously once fire implies (phase is not menu weak_until boss_dead)",
            "if from each `spray` behind `fire` on, `boss_dead` must come before `phase is menu`",
        ),
    ],
    "spray must come before boss_dead": [
        (
            "require not boss_dead weak_until spray",
            "if no `boss_dead` may come before the first `spray`, and may come at the same step",
        ),
        ("require not boss_dead until spray", "if `spray` must come, before `boss_dead` or with it"),
        (
            "keep boss_dead implies previously (not boss_dead since (spray and not boss_dead))",
            "if each `boss_dead` needs its own `spray`",
        ),
    ],
    "reach fire then spray then boss_dead within 5 s": IN_ORDER_WITHIN_5_S,
    "fire, then spray, then boss_dead, within 5 s": IN_ORDER_WITHIN_5_S,
    "reach fire, spray, boss_dead in this order within 5 s": IN_ORDER_WITHIN_5_S,
    "after fire keep health == previous(health)": [
        (
            "keep previously once fire implies health >= previous(health) and health <= previous(health)",
            "from the step after `fire` on",
        ),
        (
            "keep fire implies always (health >= previous(health) and health <= previous(health))",
            "from the step of `fire` on, which is then compared with the step before it",
        ),
    ],
    "once fire, health never changes again": [
        (
            "keep previously once fire implies health >= previous(health) and health <= previous(health)",
            "from the step after `fire` on",
        ),
        (
            "keep fire implies always (health >= previous(health) and health <= previous(health))",
            "from the step of `fire` on, which is then compared with the step before it",
        ),
    ],
    "health never changes after fire": [
        (
            "keep previously once fire implies health >= previous(health) and health <= previous(health)",
            "from the step after `fire` on",
        ),
        (
            "keep fire implies always (health >= previous(health) and health <= previous(health))",
            "from the step of `fire` on, which is then compared with the step before it",
        ),
    ],
    "fire implies health never changes again": [
        (
            "keep previously once fire implies health >= previous(health) and health <= previous(health)",
            "from the step after `fire` on",
        ),
        (
            "keep fire implies always (health >= previous(health) and health <= previous(health))",
            "from the step of `fire` on, which is then compared with the step before it",
        ),
    ],
    "keep coins == previous(coins) after fire": [
        ("keep previously once fire implies coins == previous(coins)", "from the step after `fire` on"),
        (
            "keep fire implies always coins == previous(coins)",
            "from the step of `fire` on, which is then compared with the step before it",
        ),
    ],
    "fire again only after spray": [
        (
            "keep begins fire and previously once begins fire implies previously (not "
            "begins fire since (spray and not begins fire))",
            "if steps in a row count once",
        ),
        (
            "keep fire and previously once fire implies previously (not fire since (spray and not fire))",
            "if each step counts",
        ),
    ],
    "fire only again after spray": [
        (
            "keep begins fire and previously once begins fire implies previously (not "
            "begins fire since (spray and not begins fire))",
            "if steps in a row count once",
        ),
        (
            "keep fire and previously once fire implies previously (not fire since (spray and not fire))",
            "if each step counts",
        ),
    ],
    "no fire again until spray": [
        ("keep begins fire implies weak_next (not begins fire weak_until spray)", "if steps in a row count once"),
        ("keep fire implies weak_next (not fire weak_until spray)", "if each step counts"),
    ],
    "no second fire without spray": [
        (
            "keep begins fire and previously once begins fire implies previously (not "
            "begins fire since (spray and not begins fire))",
            "if steps in a row count once",
        ),
        (
            "keep fire and previously once fire implies previously (not fire since (spray and not fire))",
            "if each step counts",
        ),
    ],
    "fire again only when spray": [
        ("keep begins fire and previously once begins fire implies spray", "if steps in a row count once"),
        ("keep fire and previously once fire implies spray", "if each step counts"),
    ],
    "no fire and spray when boss_dead": [
        ("keep boss_dead implies not (fire and spray)", "if `fire` and `spray` must not hold together"),
        ("keep boss_dead implies not fire and spray", "if `fire` must not hold, and `spray` must"),
    ],
    "when boss_dead, no fire and spray": [
        ("keep boss_dead implies not (fire and spray)", "if `fire` and `spray` must not hold together"),
        ("keep boss_dead implies not fire and spray", "if `fire` must not hold, and `spray` must"),
    ],
    "no fire and no spray when boss_dead": [
        ("keep boss_dead implies not fire and not spray", "if `boss_dead` is a condition of both")
    ],
    "no fire or spray when boss_dead": [
        ("keep boss_dead implies not fire and not spray", "if `boss_dead` is a condition of both")
    ],
    "keep ends fire implies always for 0.5 s not fire unless spray or boss_dead": [
        (
            "keep ends fire implies (always for 0.5 s not fire) or (not fire until (spray or boss_dead))",
            "if `spray or boss_dead` ends that time",
        ),
        (
            "keep ends fire implies spray or boss_dead or (always for 0.5 s not fire)",
            "if `spray or boss_dead` counts only at the first step of that time",
        ),
        (
            "keep ends fire implies always for 0.5 s (not fire or spray or boss_dead)",
            "if it excuses the steps with `spray or boss_dead` alone",
        ),
    ],
    "when fire, spray for 3 s unless boss_dead": [
        ("keep fire implies (always for 3 s spray) or (spray until boss_dead)", "if `boss_dead` ends that time"),
        (
            "keep fire implies boss_dead or (always for 3 s spray)",
            "if `boss_dead` counts only at the first step of that time",
        ),
        ("keep fire implies always for 3 s (spray or boss_dead)", "if it excuses the steps with `boss_dead` alone"),
    ],
    "spray for 3 s after fire unless boss_dead": [
        ("keep fire implies (always for 3 s spray) or (spray until boss_dead)", "if `boss_dead` ends that time"),
        (
            "keep fire implies boss_dead or (always for 3 s spray)",
            "if `boss_dead` counts only at the first step of that time",
        ),
        ("keep fire implies always for 3 s (spray or boss_dead)", "if it excuses the steps with `boss_dead` alone"),
    ],
    "when fire, always spray unless boss_dead": [
        ("keep fire implies (spray weak_until boss_dead)", "if `boss_dead` ends it for good"),
        ("keep fire implies always (spray or boss_dead)", "if it goes on after each `boss_dead`"),
    ],
    "after fire keep spray unless boss_dead": [
        ("keep fire implies spray or boss_dead", "for each step with the condition"),
        ("keep fire implies (spray weak_until boss_dead)", "if `boss_dead` ends it for good"),
        ("keep fire implies always (spray or boss_dead)", "if it goes on after each `boss_dead`"),
    ],
    "between two fire there is a spray": [
        (
            "keep begins fire and previously once fire implies previously (not begins fire since (spray "
            "and not begins fire))",
            "if it must come at some step between them",
        ),
        ("keep not fire and previously once fire implies spray", "if it must hold at every step between them"),
    ],
    "between ends fire and begins fire at least once spray": [
        (
            "keep begins fire and previously once fire implies previously (not fire since (spray and not fire))",
            "",
        ),
    ],
}


@pytest.mark.parametrize("typed", ONE_READING)
def test_a_sentence_has_the_reading(typed: str) -> None:
    (reading,) = read(typed).readings
    assert list(reading.clauses) == ONE_READING[typed]
    assert not reading.condition
    assert is_valid(reading.clauses)


@pytest.mark.parametrize("typed", SEVERAL_READINGS)
def test_a_sentence_has_several_readings(typed: str) -> None:
    readings = read(typed).readings
    assert [(*reading.clauses, reading.condition) for reading in readings] == SEVERAL_READINGS[typed]
    assert all(is_valid(reading.clauses) for reading in readings)


def help_of(typed: str) -> str:
    return errors(spec(typed))[0].help or ""


@pytest.mark.parametrize(
    ("typed", "clause"),
    [
        ("no fire and no spray when boss_dead", "`keep boss_dead implies not fire and not spray`"),
        ("avoid fire and avoid spray when boss_dead", "`keep boss_dead implies not fire and not spray`"),
        ("when fire, not spray before boss_dead", "`keep fire implies (not spray weak_until boss_dead)`"),
        ("fire again only after spray", "`keep fire and previously once fire implies previously"),
        ("fire must not happen again until spray", "`keep fire implies weak_next (not fire weak_until spray)`"),
        ("when fire, spray for 3 s unless boss_dead", "(spray until boss_dead)"),
        ("after fire keep coins == previous(coins)", "`keep previously once fire implies coins == previous(coins)`"),
        ("when fire for exactly 3 s, spray", "`keep begins (time_holding(fire) >= 3 s) implies spray`"),
        ("fire only if spray since the last fire", "previously (not fire since (spray and not fire))"),
    ],
)
def test_a_pattern_leaves_a_sentence_with_two_readings_to_the_grammar(typed: str, clause: str) -> None:
    assert clause in help_of(typed)


@pytest.mark.parametrize(
    "typed", ["keep fire implies spray before boss_dead", "keep fire before spray implies coins > 3"]
)
def test_an_answer_with_before_is_helped_in_the_words_of_the_writer(typed: str) -> None:
    assert "`keep b implies" not in help_of(typed)


def test_two_comparisons_of_a_number_with_fractions_are_explained() -> None:
    note = "`health` has fractions, which `==` cannot compare: two comparisons say the same"
    assert help_of("after fire keep health == previous(health)").splitlines()[1:] == [note]
    assert help_of("after fire keep coins == previous(coins)").splitlines()[1:] == []


def test_a_condition_that_lasts_asks_at_each_step_for_what_must_come_first() -> None:
    note = "each step with `fire` asks for `spray` anew; write `begins` before it if one is enough each time"
    assert help_of("when fire, no boss_dead before spray").splitlines()[1:] == [note]
    assert help_of("when fire begins, no boss_dead before spray").splitlines()[1:] == []
    assert help_of("when fire, spray until boss_dead").splitlines()[1:] == []


def is_violated(clause: str, steps: str) -> bool:
    """Return whether steps such as `fs - b` violate a clause: the letters of the signals that hold, `-` for none."""
    (fspa,) = compile_text(f"clock 10 Hz\nsignal f: bool\nsignal s: bool\nsignal b: bool\nspec s {{ {clause} }}")
    monitor = Monitor(fspa)
    *_, last = [monitor.step({name: name in step for name in "fsb" if name in clause}) for step in steps.split()]
    return last.verdict == "violated"


@pytest.mark.parametrize(
    ("steps", "is_kept"),
    [("s f s f", True), ("s f f", False), ("f", False), ("s f - s - f", True), ("s fs f", False)],
)
def test_each_event_needs_another_one_since_the_event_before(steps: str, is_kept: bool) -> None:
    assert is_violated("keep f implies previously (not f since (s and not f))", steps) is not is_kept


def test_the_step_of_an_event_is_compared_with_the_step_before_or_not() -> None:
    head = "clock 10 Hz\nsignal f: bool\nsignal n: int in [0, 9]\n"
    violated = []
    for clause in ("keep previously once f implies n == previous(n)", "keep f implies always n == previous(n)"):
        (fspa,) = compile_text(f"{head}spec s {{ {clause} }}")
        monitor = Monitor(fspa)
        *_, last = [monitor.step({"f": f, "n": n}) for f, n in ((False, 1), (True, 2), (False, 2))]
        violated.append(last.verdict == "violated")
    assert violated == [False, True]


def test_a_time_that_is_compared_with_steps_is_told_in_seconds() -> None:
    assert "`4 steps` are `0.4 s` with this clock" in help_of("keep time_holding(fire) == 4 steps implies spray")
