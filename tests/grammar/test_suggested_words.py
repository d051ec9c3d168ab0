"""A help for English about durations, conditions, quantifiers and changes accepts the traces that are meant."""

from __future__ import annotations

import re

import pytest

from tests.grammar.suggestions import NAMES, Meaning, Trace, a, b, check, error_of, starts, suggestions
from tests.grammar.test_suggested_events import ENTITIES
from tltlc import compile_text
from tltlc.monitor import Monitor


def longest(trace: Trace) -> int:
    """Return the greatest time for which a holds: a step of one second less than its samples."""
    runs = "".join("x" if held else " " for held in a(trace)).split()
    return max((len(run) - 1 for run in runs), default=-1)


def holds_only_after(trace: Trace) -> bool:
    return all(any(b(trace)[: i + 1]) for i, held in enumerate(a(trace)) if held)


MEANINGS: dict[str, Meaning] = {
    "reach a for at least 2 s": lambda t: longest(t) >= 2,
    "reach a for at least 2 steps": lambda t: longest(t) + 1 >= 2,
    "reach a for more than 2 seconds": lambda t: longest(t) > 2,
    "keep a for at most 2 s": lambda t: longest(t) <= 2,
    "require (a) for no more than 2 s": lambda t: longest(t) <= 2,
    "keep a for less than 2 s": lambda t: longest(t) < 2,
    "avoid a for at least 2 s": lambda t: longest(t) < 2,
    "never a for more than 2 s": lambda t: longest(t) <= 2,
    "keep a only if b": lambda t: not any(x and not y for x, y in t),
    "keep a only when b": lambda t: not any(x and not y for x, y in t),
    "keep a only after b": holds_only_after,
    "avoid a for longer than 2 s": lambda t: longest(t) <= 2,
    "keep a requires once b": holds_only_after,
    "keep a ==> b": lambda t: not any(x and not y for x, y in t),
    "keep a --> b": lambda t: not any(x and not y for x, y in t),
    "keep a <=> b": lambda t: a(t) == b(t),
    "keep a <==> b": lambda t: a(t) == b(t),
    "keep a AND b": lambda t: all(x and y for x, y in t),
    "keep times(a) < 1 AND b": lambda t: all(b(t)) and not any(a(t)),
    "keep times(a) < 1 OR b": lambda t: all(event or not any(a(t)[: i + 1]) for i, event in enumerate(b(t))),
    "keep within 2 s of b: a": lambda t: all(any(a(t)[i : i + 3]) for i, event in enumerate(b(t)) if event),
    "keep b implies once in 2 s a": lambda t: all(
        any(a(t)[max(i - 2, 0) : i + 1]) for i, event in enumerate(b(t)) if event
    ),
    "keep not a twice within 2 s": lambda t: not any(0 < j - i <= 2 for i in starts(t) for j in starts(t)),
    "keep times(a) <= 1 within 2 s": lambda t: not any(0 < j - i <= 2 for i in starts(t) for j in starts(t)),
    "avoid times(a) >= 2 within 2 s": lambda t: not any(0 < j - i <= 2 for i in starts(t) for j in starts(t)),
}


@pytest.mark.parametrize(("clause", "meaning"), MEANINGS.items(), ids=MEANINGS)
def test_a_suggestion_has_the_meaning_of_the_sentence(clause: str, meaning: Meaning) -> None:
    (suggestion,) = suggestions(clause)
    check(suggestion, meaning)


def test_a_rule_about_a_long_time_gets_each_reading() -> None:
    assert error_of("keep a for at least 2 s")[1].fixes == ()
    start, each, some = suggestions("keep a for at least 2 s")
    check(start, lambda t: all(a(t)[:2]))
    check(each, lambda t: all(all(a(t)[i : i + 2]) for i in starts(t)))
    check(some, lambda t: longest(t) >= 2)


@pytest.mark.parametrize("verb", ["requires", "needs"])
def test_a_rule_that_requires_something_gets_both_readings(verb: str) -> None:
    assert error_of(f"keep a {verb} b")[1].fixes == ()
    (now, before) = (reading for reading in suggestions(f"keep a {verb} b") if reading != "require b")
    check(now, lambda t: not any(x and not y for x, y in t))
    check(before, holds_only_after)


@pytest.mark.parametrize(
    ("clause", "readings"),
    [
        ("avoid b implies a for the next 3 s", ["always for 3 s a"]),
    ],
)
def test_the_readings_of_an_unclear_formula_compile(clause: str, readings: list[str]) -> None:
    error = error_of(clause)[1]
    assert error.fixes == ()
    assert re.findall("`([^`]*)`", error.help or "") == readings
    for reading in readings:
        compile_text(f"{NAMES}spec s {{ avoid {reading} }}")


@pytest.mark.parametrize("clause", ["keep phase never falls by more than 1", "keep phase never falls more than 1"])
def test_a_change_that_must_not_happen_is_no_limit_of_the_value(clause: str) -> None:
    error = error_of(clause)[1]
    assert error.fixes == ()
    step, since = re.findall("`([^`]*)`", error.help or "")
    for reading, right in ((step, [3, 2, 1, 0]), (since, [3, 2, 3, 2])):
        (fspa,) = compile_text(f"{NAMES}spec s {{ {reading} }}")
        for phases, is_kept in ((right, True), ([3, 1], False), ([0, 3], True)):
            monitor = Monitor(fspa)
            assert [monitor.step({"phase": phase}).accepting for phase in phases][-1] == is_kept


@pytest.mark.parametrize(
    ("clause", "right"),
    [
        ("phase never below 2", [2, 3]),
        ("phase never drops below 2", [2, 3]),
        ("phase never more than 2", [0, 1, 2]),
        ("phase equals 2", [2]),
        ("phase is equal to 2", [2]),
        ("phase not equal 2", [0, 1, 3]),
        ("phase is not equal to 2", [0, 1, 3]),
    ],
)
def test_a_comparison_in_words_holds_at_the_values_that_are_meant(clause: str, right: list[int]) -> None:
    (suggestion,) = suggestions(f"keep {clause}")
    (fspa,) = compile_text(f"{NAMES}spec s {{ {suggestion} }}")
    assert [value for value in range(4) if Monitor(fspa).step({"phase": value}).accepting] == right


@pytest.mark.parametrize(
    ("clause", "meant"),
    [
        *(
            (f"keep {word} x in pits: seen(x)", "keep all x in pits: seen(x)")
            for word in ("for all", "for each", "for every", "forall", "each", "every")
        ),
        *(
            (f"reach {word} x in pits: seen(x)", "reach any x in pits: seen(x)")
            for word in ("exists", "there exists", "some", "for some")
        ),
        ("keep a implies (for all x in pits: seen(x))", "keep a implies (all x in pits: seen(x))"),
        ("keep seen(x) for all x in pits", "keep all x in pits: seen(x)"),
        ("reach seen(x) for some x in (p1, p2)", "reach any x in (p1, p2): seen(x)"),
        (
            "keep all x in pits: falls(x) at most once in 10 s",
            "avoid any x in pits: (begins falls(x)) then within 10 s (begins falls(x))",
        ),
        (
            "keep all x in pits: not falls(x) twice within 10 s",
            "avoid any x in pits: (begins falls(x)) then within 10 s (begins falls(x))",
        ),
        ("keep all x in pits: seen(x) for at most 3 s", "keep all x in pits: time_holding(seen(x)) <= 3 s"),
        ("reach time_holding(a) > 3 frames", "reach time_holding(a) > 3 s"),
        ("reach a then within 500 msec seen(p1)", "reach a then within 500 ms seen(p1)"),
        ("reach a then within 1500 milliseconds seen(p1)", "reach a then within 1500 ms seen(p1)"),
    ],
)
def test_a_quantifier_or_a_unit_is_rewritten(clause: str, meant: str) -> None:
    (suggestion,) = suggestions(clause, ENTITIES)
    assert suggestion.strip() == meant
    if "500" not in meant:
        compile_text(f"{ENTITIES}spec s {{ {meant} }}")


def test_for_any_gets_both_quantifiers() -> None:
    error = error_of("keep for any x in pits: seen(x)", ENTITIES)[1]
    assert error.fixes == ()
    assert error.help == "write `all x in pits` if it must hold for each of them, `any x in pits` if for at least one"


def test_a_number_of_frames_that_is_no_round_time_gets_no_fix() -> None:
    error = error_of("reach time_holding(a) > 100 frames", ENTITIES.replace("1 Hz", "60 Hz"))[1]
    assert error.fixes == ()
    assert error.help == (
        "compare a time with seconds; steps count samples: `100 frames` are about `1.66667 s` with this clock"
    )


@pytest.mark.parametrize(
    ("clause", "help_"),
    [
        (
            "avoid phase drops by 2 within 5 s",
            "no clause says by how much `phase` changes in 5 s "
            "(`previous(phase, 5 s)` is the value 5 s before): "
            "let the game record that number as a signal, such as `signal phase_change in [-100, 100]`, and compare it",
        ),
        ("keep always within 2 s of a, b", "write `keep within 2 s of a, b`"),
        (
            "keep a implies eventually within 2 s of b",
            "write `eventually within 2 s a`: only an event stands after `of`, and what answers it after a comma",
        ),
        (
            "avoid a for less than 2 s",
            "`time_holding(a)` is how long it has held: compare it, as in `time_holding(a) < 2 s`",
        ),
    ],
)
def test_a_sentence_that_has_no_one_form_says_what_to_write(clause: str, help_: str) -> None:
    error = error_of(clause)[1]
    assert error.fixes == ()
    assert error.help == help_


def test_no_before_an_absence_has_its_own_fix() -> None:
    assert next(suggestions("keep no a for 2 s after b")).strip() == "keep b implies always for 2 s not a"
