"""TLT0478: rules about the last seconds in which a condition, which holds now, may not have held."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from functools import cache

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.fuzzing import times
from tests.tools.lint.helpers import RANGES, accepted_traces, block, codes, findings_in
from tltlc.automaton.fspa import Fspa
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.monitor.monitor import Monitor
from tltlc.pipeline import compile_text

CODE = "TLT0478"
BEFORE = (
    f"clock 1 Hz\n{RANGES}signal n: int in [0, 9]\nsignal mode: (walk, run)\nlet menu = mode is run\n"
    "entity guards = g1, g2\nsignal lit(g: entity): bool\nsignal hit(g: entity): bool\n"
)
Sample = tuple[bool, bool, int]
"""The values of a, b and n at a step."""
SAMPLES = st.lists(st.tuples(st.booleans(), st.booleans(), st.integers(0, 6)), min_size=1, max_size=14)


def note_on(clause: str, before: str = BEFORE) -> Diagnostic:
    (note,) = (item.diagnostic for item in findings_in(block(clause, before=before)) if item.diagnostic.code == CODE)
    return note


@pytest.mark.parametrize(
    ("clause", "offered"),
    [
        ("keep a implies x >= highest_within(x, 3 s) - 5", "x >= highest_since(x, begins a) - 5"),
        ("keep not a implies x <= lowest_within(x, 3 s) + 5", "x <= lowest_since(x, begins not a) + 5"),
        ("keep a or b implies highest_within(x, 3 s) - x <= 5", "highest_since(x, begins (a or b)) - x <= 5"),
        ("keep a implies x > 0.5 * highest_within(x, 3 s)", "x > 0.5 * highest_since(x, begins a)"),
        ("keep mode is run implies times_within(b, 3 s) <= 2", "times_since(b, begins mode is run) <= 2"),
        ("keep menu implies 3 > times_within(b, 3 s)", "3 > times_since(b, begins menu)"),
        ("keep n > 3 implies times_within(b, 3 s, 4) + x < 3", "times_since(b, begins n > 3, 4) + x < 3"),
        ("keep a implies total_time_within(b, 3 s) <= 2 s", "total_time_since(b, begins a) <= 2 s"),
    ],
)
def test_a_window_in_an_answer_gets_a_note(clause: str, offered: str) -> None:
    note = note_on(clause)
    assert note.severity == "note"
    assert f"`{clause} or {offered}`" in (note.help or "")


@pytest.mark.parametrize(
    ("clause", "offered"),
    [
        (
            "keep a implies c and times_within(b, 3 s) <= 2",
            "keep a implies c and (times_within(b, 3 s) <= 2 or times_since(b, begins a) <= 2)",
        ),
        (
            "require always (a implies (times_within(b, 3 s) <= 2))",
            "require always (a implies (times_within(b, 3 s) <= 2 or times_since(b, begins a) <= 2))",
        ),
        (
            "keep all g in guards: lit(g) implies times_within(hit(g), 3 s) <= 2",
            "keep all g in guards: lit(g) implies times_within(hit(g), 3 s) <= 2 "
            "or times_since(hit(g), begins lit(g)) <= 2",
        ),
        (
            "keep a implies // at most twice\n        times_within(b, 3 s) <= 2",
            "keep a implies times_within(b, 3 s) <= 2 or times_since(b, begins a) <= 2",
        ),
    ],
)
def test_the_offered_clause_is_whole(clause: str, offered: str) -> None:
    assert f"`{offered}`" in (note_on(clause).help or "")


def a_begins(trace: Sequence[Sample]) -> int:
    """Return the step at which the stretch with a began that goes on at the last step."""
    return next(step for step in reversed(range(len(trace))) if not step or not trace[step - 1][0])


def highest_fall(trace: Sequence[Sample]) -> bool:
    last = len(trace) - 1
    return trace[-1][2] >= max(n for _, _, n in trace[max(last - 3, a_begins(trace)) :]) - 2


def highest_rise(trace: Sequence[Sample]) -> bool:
    last = len(trace) - 1
    return trace[-1][2] <= min(n for _, _, n in trace[max(last - 3, a_begins(trace)) :]) + 2


def beginnings(trace: Sequence[Sample]) -> bool:
    last = len(trace) - 1
    steps = range(max(last - 3, a_begins(trace)), last + 1)
    return sum(trace[step][1] and (not step or not trace[step - 1][1]) for step in steps) <= 1


def time_in_all(trace: Sequence[Sample]) -> bool:
    """Whether b has held for at most 1 s; each step has lasted since the one before it, and the first one 0 s."""
    last = len(trace) - 1
    return sum(trace[step][1] for step in range(max(last - 2, a_begins(trace), 1), last + 1)) <= 1


@cache
def offered_for(limit: str) -> Fspa:
    """Return the automaton of the clause that the note offers for a limit while a holds."""
    before = "clock 1 Hz\nsignal a: bool\nsignal b: bool\nsignal n: int in [0, 6]\n"
    (offered,) = re.findall(r"`(keep [^`]*)`", note_on(f"keep a implies {limit}", before).help or "")
    (fspa,) = compile_text(block(offered, before=before))
    return fspa


@pytest.mark.parametrize(
    ("limit", "holds"),
    [
        ("n >= highest_within(n, 3 s) - 2", highest_fall),
        ("n <= lowest_within(n, 3 s) + 2", highest_rise),
        ("times_within(b, 3 s) <= 1", beginnings),
        ("total_time_within(b, 3 s) <= 1 s", time_in_all),
    ],
)
@times(200)
@given(SAMPLES)
def test_the_offered_clause_is_about_the_steps_of_the_window_since_the_condition_began(
    limit: str, holds: Callable[[Sequence[Sample]], bool], trace: Sequence[Sample]
) -> None:
    monitor, is_kept = Monitor(offered_for(limit)), True
    for step, (a, b, n) in enumerate(trace):
        is_kept = is_kept and (not a or holds(trace[: step + 1]))
        assert monitor.step({"a": a, "b": b, "n": n}).accepting == is_kept


def test_the_note_and_the_clause_differ_before_the_condition() -> None:
    before = "clock 1 Hz signal a: bool signal b: bool\n"
    limit = "times_within(b, 3 s) <= 1"
    typed, offered = (
        accepted_traces(block(f"keep a implies {rule}", before=before), "ab", 4)
        for rule in (limit, f"{limit} or times_since(b, begins a) <= 1")
    )
    assert ("b", "", "ab") in offered - typed
    assert typed < offered


@pytest.mark.parametrize(
    ("condition", "offered"),
    [
        ("times_within(b, 3 s) >= 3 and a", "times_within(begins b and a, 3 s) >= 3 and a"),
        ("3 < times_within(begins b, 3 s) and menu", "3 < times_within(begins b and menu, 3 s) and menu"),
        (
            "not a and times_within(b or c, 3 s, 9) > 1 and mode is walk",
            "not a and times_within(begins (b or c) and not a and mode is walk, 3 s, 9) > 1 and mode is walk",
        ),
        ("total_time_within(b, 3 s) > 2 s and a", "total_time_within(b and a, 3 s) > 2 s and a"),
    ],
)
def test_a_window_in_a_condition_gets_a_note(condition: str, offered: str) -> None:
    for answer in ("x > 3", "x > 3 and y > 3", "weak_next x > 3"):
        assert f"`{offered}`" in (note_on(f"keep {condition} implies {answer}").help or "")


def test_the_offered_condition_counts_what_begins_in_the_state() -> None:
    before = "clock 1 Hz signal a: bool signal b: bool\n"
    typed, offered = (
        accepted_traces(block(f"keep times_within({event}, 3 s) >= 2 and a implies not b", before=before), "ab", 4)
        for event in ("b", "begins b and a")
    )
    assert typed < offered
    assert ("b", "", "ab") in offered - typed
    # A b that goes on where a begins has begun before it.
    assert ("b", "ab", "", "ab") in offered
    assert ("ab", "", "ab") not in offered


@pytest.mark.parametrize(
    "clause",
    [
        "keep x >= highest_within(x, 3 s) - 5",
        "keep begins a implies x >= highest_within(x, 3 s) - 5",
        "keep b and ends a implies x >= highest_within(x, 3 s) - 5",
        "keep historically for 3 s a implies x >= highest_within(x, 3 s) - 5",
        "keep time_holding(a) >= 3 s implies x >= highest_within(x, 3 s) - 5",
        "keep times(a) >= 3 implies x >= highest_within(x, 3 s) - 5",
        "keep x > 5 implies x >= highest_within(x, 3 s) - 5",
        "keep a implies y >= highest_within(x, 3 s) - 5",
        "keep a implies x <= highest_within(x, 3 s) - 1",
        "keep a implies x >= lowest_within(x, 3 s) + 1",
        "keep a implies x >= highest_within(x, 3 s) - lowest_within(x, 3 s)",
        "keep a implies x >= highest_within(x, 3 s) - 5 or b",
        "keep a implies weak_next x >= highest_within(x, 3 s) - 5",
        "keep a implies (b implies x >= highest_within(x, 3 s) - 5)",
        "keep a implies times_within(b, 3 s) <= 0",
        "keep a implies times_within(a and b, 3 s) <= 2",
        "keep a implies times_within(b, 3 s, 5) + times_within(c, 3 s, 5) <= 2",
        "keep menu implies times_within(mode is walk, 3 s) <= 2",
        "keep a implies x >= highest_within(x, 3 s) - 5 or x >= highest_since(x, begins a) - 5",
        "keep times_within(b, 3 s) >= 2 implies c",
        "keep times_within(b, 3 s) >= 1 and a implies c",
        "keep times_within(b, 3 s) <= 2 and a implies c",
        "keep times_within(b, 3 s) >= 2 and begins a implies c",
        "keep times_within(b, 3 s) >= 2 and n > 3 implies c",
        "keep times_within(begins b and a, 3 s) >= 2 and a implies c",
    ],
)
def test_other_rules_get_none(clause: str) -> None:
    assert CODE not in codes(block(clause, before=BEFORE))


@pytest.mark.parametrize(
    ("clause", "offered"),
    [
        (
            "keep a implies highest_within(x, 3 s) - lowest_within(x, 3 s) <= 5",
            "keep time_holding(a) >= 3 s implies highest_within(x, 3 s) - lowest_within(x, 3 s) <= 5",
        ),
        ("keep a implies times_within(b, 3 s) >= 2", "keep time_holding(a) >= 3 s implies times_within(b, 3 s) >= 2"),
        (
            "keep mode is run implies total_time_within(b, 3 s) >= 1 s",
            "keep time_holding(mode is run) >= 3 s implies total_time_within(b, 3 s) >= 1 s",
        ),
    ],
)
def test_a_least_count_that_the_start_of_a_condition_misses_gets_a_note(clause: str, offered: str) -> None:
    assert f"write `{offered}`" in (note_on(clause).help or "")


@given(SAMPLES)
def test_a_least_count_is_asked_for_once_the_condition_has_lasted_that_time(samples: list[Sample]) -> None:
    monitor, is_kept = Monitor(offered_for("times_within(b, 3 s) >= 1")), True
    begins = [b and not (step and samples[step - 1][1]) for step, (_, b, _) in enumerate(samples)]
    for step, (a, b, _) in enumerate(samples):
        has_lasted = step >= 3 and all(a for a, _, _ in samples[step - 3 : step + 1])
        is_kept = is_kept and (not has_lasted or any(begins[step - 3 : step + 1]))
        assert monitor.step({"a": a, "b": b}).accepting == is_kept
