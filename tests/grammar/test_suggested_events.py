"""A help for English about events and what follows them accepts the traces that the sentence means."""

from __future__ import annotations

import re

import pytest

from tests.grammar.suggestions import (
    NAMES,
    VARIES,
    Meaning,
    Trace,
    a,
    b,
    begins_twice_in_time,
    check,
    error_of,
    starts,
    suggestions,
)
from tltlc import compile_text

ENTITIES = """
clock 1 Hz
entity p1, p2
entity pits = p1, p2
signal falls(x: entity): bool
signal seen(x: entity): bool
signal a: bool
"""


def does_not_begin_twice_in_time(trace: Trace) -> bool:
    return not begins_twice_in_time(trace)


def ends_in_time(trace: Trace) -> bool:
    """Whether a does not hold at one of the two steps after each a."""
    return all(not all(a(trace)[i : i + 3]) if i + 2 < len(trace) else not all(a(trace)[i:]) for i in range(len(trace)))


def is_single_and_apart(trace: Trace) -> bool:
    """Whether a holds at none of the two steps after a step at which it begins."""
    return not any(any(a(trace)[i + 1 : i + 3]) for i in starts(trace))


def lasts(trace: Trace) -> bool:
    """Whether a holds for two steps from each step on at which it begins."""
    return all(all(a(trace)[i : i + 2]) for i in starts(trace))


def holds_after(trace: Trace) -> bool:
    """Whether a holds for two steps from each b on."""
    return all(all(a(trace)[i : i + 2]) for i, event in enumerate(b(trace)) if event)


def lacks_after(trace: Trace) -> bool:
    """Whether a is false for two steps from each b on."""
    return not any(any(a(trace)[i : i + 2]) for i, event in enumerate(b(trace)) if event)


MEANINGS: dict[str, Meaning] = {
    "avoid a within 2 s of a": does_not_begin_twice_in_time,
    "avoid begins a within 2 s of begins a": does_not_begin_twice_in_time,
    "avoid a within 2 s of begins a": does_not_begin_twice_in_time,
    "keep not a within 2 s of a": does_not_begin_twice_in_time,
    "keep begins a implies not (begins a) within 2 s": does_not_begin_twice_in_time,
    "keep begins a implies not begins a for 2 s": does_not_begin_twice_in_time,
    "require not a within 2 s of a": does_not_begin_twice_in_time,
    "reach a within 2 s of a": begins_twice_in_time,
    "reach begins a within 2 s of begins a": begins_twice_in_time,
    "keep a for 2 s after a": lasts,
    "keep after a, a for 2 s": lasts,
    "keep a for 2 s after b": holds_after,
    "a for 2 s after b": holds_after,
    "require always for 2 s a after b": holds_after,
    "keep always for 2 s a after b": holds_after,
    "avoid begins a within 2 s of b": lambda t: (
        not any(j in range(i, i + 3) for i, event in enumerate(b(t)) if event for j in starts(t))
    ),
}


@pytest.mark.parametrize(("clause", "meaning"), MEANINGS.items(), ids=MEANINGS)
def test_a_suggestion_has_the_meaning_of_the_sentence(clause: str, meaning: Meaning) -> None:
    (suggestion,) = suggestions(clause)
    check(suggestion, meaning)


@pytest.mark.parametrize("clause", ["keep not a for 2 s after b", "avoid a for 2 s after b"])
def test_what_is_denied_after_a_state_counts_from_each_of_its_steps_or_from_its_end(clause: str) -> None:
    first, last = re.findall("`(keep [^`]*)`", error_of(clause)[1].help or "")
    check(first, lacks_after)
    assert last == "keep ends b implies always for 2 s not a"


@pytest.mark.parametrize(
    "clause",
    [
        "avoid a within 2 s after a",
        "avoid (a) within 2 s after (a)",
        "no a for 2 s after a",
        "avoid a again within 2 s",
        "keep a implies not a for 2 s",
        "keep not a for 2 s after a",
        "after a, not a for 2 s",
    ],
)
def test_what_must_not_follow_itself_may_last_or_count_from_its_end(clause: str) -> None:
    assert error_of(clause)[1].fixes == ()
    again, single, ended = suggestions(clause)
    check(again, does_not_begin_twice_in_time)
    check(single, is_single_and_apart)
    assert ended == "keep ends a implies always for 2 s not a"


@pytest.mark.parametrize(
    "clause",
    [
        "keep a implies not a within 2 s",
        "when a then not a within 2 s",
        "if a then not a within 2 s",
        "whenever a, not a within 2 s",
    ],
)
def test_an_event_that_must_not_hold_in_time_must_end(clause: str) -> None:
    (ends,) = suggestions(clause)
    check(ends, ends_in_time)
    assert "avoid (begins a) then within 2 s (begins a)" in (error_of(clause)[1].help or "")


def test_an_event_that_must_not_hold_in_time_after_itself_must_end_or_not_come_again() -> None:
    clause = "keep after a, not a within 2 s"
    assert error_of(clause)[1].fixes == ()
    ends, again = suggestions(clause)
    check(ends, ends_in_time)
    check(again, does_not_begin_twice_in_time)


def test_a_quantifier_stays_before_both_readings() -> None:
    clause = "keep all x in (p1, p2): falls(x) implies not falls(x) within 2 s"
    assert [*suggestions(clause, ENTITIES)] == [
        "keep all x in (p1, p2): falls(x) implies eventually within 2 s not falls(x)",
        "avoid any x in (p1, p2): (begins falls(x)) then within 2 s (begins falls(x))",
    ]


def test_only_a_sentence_about_beginnings_gets_a_fix() -> None:
    assert error_of("avoid begins a within 2 s of begins a")[1].fixes
    assert error_of("avoid a within 2 s of a")[1].fixes == ()


@pytest.mark.parametrize("clause", ["avoid a within 2 steps of a", "keep a for 2 steps after b"])
def test_steps_need_a_fixed_clock(clause: str) -> None:
    error = error_of(clause, VARIES)[1]
    assert error.fixes == ()
    assert error.help == "this needs a fixed clock: declare the rate of the game, e.g. `clock 60 Hz`"


@pytest.mark.parametrize(
    ("clause", "suggestion"),
    [
        ("keep all x in pits: seen(x) within 2 s of a", "keep all x in pits: within 2 s of a, seen(x)"),
        (
            "keep all x in pits: seen(x) for 2 s after falls(x)",
            "keep all x in pits: falls(x) implies always for 2 s seen(x)",
        ),
        (
            "avoid any x in pits: seen(x) within 2 s of a",
            "keep all x in pits: a implies not eventually within 2 s seen(x)",
        ),
        (
            "keep all x in pits: not falls(x) within 2 s of falls(x)",
            "avoid any x in pits: (begins falls(x)) then within 2 s (begins falls(x))",
        ),
    ],
)
def test_a_quantifier_stays_before_its_answer(clause: str, suggestion: str) -> None:
    assert [text.strip() for text in suggestions(clause, ENTITIES)] == [suggestion]
    compile_text(f"{ENTITIES}spec s {{ {suggestion} }}")


@pytest.mark.parametrize(
    "clause",
    [
        "keep any x in pits: seen(x) within 2 s of a",
        "avoid all x in pits: seen(x) within 2 s of a",
        "keep not seen(p1) and a within 2 s of a",
    ],
)
def test_an_unclear_answer_gets_both_forms_with_letters(clause: str) -> None:
    error = error_of(clause, ENTITIES)[1]
    assert error.fixes == ()
    assert error.help == (
        "write `keep within 2 s of b, a` if `a` must come within 2 s of `b`, "
        "`keep b implies not eventually within 2 s a` if it must not"
    )


def test_a_goal_that_lasts_after_an_event_gets_a_timer() -> None:
    error = error_of("reach a for 2 s after b")[1]
    assert error.fixes == ()
    assert error.help == "write `reach time_holding(a and once b) >= 2 s`"
    check(
        re.findall("`([^`]*)`", error.help)[0],
        lambda t: any(all(a(t)[i : i + 3]) and any(b(t)[: i + 1]) for i in range(len(t) - 2)),
    )


def test_an_event_that_answers_itself_says_nothing() -> None:
    assert error_of("keep a within 2 s of a", NAMES)[1].help == "`a` holds at that step itself: say what must follow it"
