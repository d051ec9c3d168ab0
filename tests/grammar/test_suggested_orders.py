"""A help for English about an order, or about a time of two formulas, accepts the traces that the sentence means."""

from __future__ import annotations

import pytest

from tests.grammar.suggestions import (
    VARIES,
    Meaning,
    Trace,
    a,
    b,
    begins_twice_in_time,
    check,
    error_of,
    suggestions,
)


def comes_first(trace: Trace) -> bool:
    """Whether no step has b unless a has held at it, or before."""
    return all(any(a(trace)[: i + 1]) for i, event in enumerate(b(trace)) if event)


def lasts_until(trace: Trace) -> bool:
    """Whether a holds at each step before the first b, or at all if there is none."""
    return all(held for i, held in enumerate(a(trace)) if not any(b(trace)[: i + 1]))


def are_apart(trace: Trace) -> bool:
    """Whether no step with a is within two steps of one with b, in either order."""
    return not any(
        abs(i - j) <= 2 for i, held in enumerate(a(trace)) if held for j, event in enumerate(b(trace)) if event
    )


def follow_in_time(trace: Trace) -> bool:
    """Whether some b is one or two steps after an a."""
    return any(0 < j - i <= 2 for i, held in enumerate(a(trace)) if held for j, goal in enumerate(b(trace)) if goal)


def follow_at_the_start(trace: Trace) -> bool:
    """Whether the first three steps have a, and later b."""
    return any(a(trace)[i] and any(b(trace)[i + 1 : 3]) for i in range(min(len(trace), 3)))


READINGS: dict[str, tuple[Meaning, ...]] = {
    "keep a before b": (comes_first, lasts_until),
    "keep once a before b": (comes_first,),
    "keep not a before b": (lambda t: not any(held and not any(b(t)[: i + 1]) for i, held in enumerate(a(t))),),
    "avoid a and b within 2 s": (are_apart, lambda t: not any(x and y for x, y in t[:3])),
    "avoid within 2 s a and b": (are_apart, lambda t: not any(x and y for x, y in t[:3])),
    "avoid (a and b) in 2 s": (are_apart, lambda t: not any(x and y for x, y in t[:3])),
    "avoid a and a within 2 s": (lambda t: not begins_twice_in_time(t),),
    "reach (a then b) within 2 s": (follow_in_time, follow_at_the_start),
    "reach a then (within 2 s b)": (follow_in_time,),
    "reach a then eventually within 2 s b": (follow_in_time,),
    "reach not a until b within 2 s": (lambda t: any(b(t)[j] and not any(a(t)[:j]) for j in range(min(len(t), 3))),),
}


@pytest.mark.parametrize(("clause", "meanings"), READINGS.items(), ids=READINGS)
def test_each_reading_has_its_meaning(clause: str, meanings: tuple[Meaning, ...]) -> None:
    readings = [
        reading
        for reading in suggestions(clause)
        # The text after the suggestion names a goal.
        if reading not in ("require a", "require b")
    ]
    assert len(readings) == len(meanings), readings
    for reading, meaning in zip(readings, meanings, strict=True):
        check(reading, meaning)


@pytest.mark.parametrize("clause", [clause for clause, meanings in READINGS.items() if len(meanings) > 1])
def test_a_sentence_with_two_readings_gets_no_fix(clause: str) -> None:
    assert error_of(clause)[1].fixes == ()


def test_a_time_of_three_formulas_is_that_of_all() -> None:
    assert error_of("reach (a then b then a) within 2 s")[1].help == (
        "write `reach a then within 2 s b then within 2 s a` if the time counts from the goal before, `require "
        "eventually within 2 s (a and previously once (b and previously once a))` if it counts from the first step on"
    )
    first, second = list(suggestions("avoid a and b and has(door) within 2 s"))
    assert first == "avoid (once within 2 s a) and (once within 2 s b) and (once within 2 s has(door))"
    assert second == "require not eventually within 2 s (a and b and has(door))"


def test_each_time_in_brackets_after_then_loses_them() -> None:
    (suggestion,) = suggestions("reach a then (within 2 s b) then (within 3 s a or b)")
    assert suggestion.strip() == "reach a then within 2 s b then within 3 s (a or b)"


@pytest.mark.parametrize("clause", ["avoid a and b within 2 steps", "reach (a then b) within 2 steps"])
def test_steps_need_a_fixed_clock(clause: str) -> None:
    assert error_of(clause, VARIES)[1].help == (
        "this needs a fixed clock: declare the rate of the game, e.g. `clock 60 Hz`"
    )
