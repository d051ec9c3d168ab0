"""TLT0481: times of goals that count from the goal just before them, and not from the first one."""

from __future__ import annotations

from itertools import product

import pytest

from tests.tools.lint.helpers import RANGES, block, codes, findings_in
from tltlc.monitor import Monitor
from tltlc.pipeline import compile_text

BEFORE = f"clock 10 Hz\n{RANGES}signal d: bool\nsignal mode: (idle, alert, chase)\n"
LENGTH = 5


@pytest.mark.parametrize(
    ("clause", "offered", "title"),
    [
        (
            "reach mode is alert then within 0.5 s c then d",
            "reach begins (mode is alert) then within 0.5 s c then d",
            "this time counts from any step with `mode is alert`",
        ),
        (
            "reach (mode is alert) then within 5 steps (c and d)",
            "reach begins (mode is alert) then within 5 steps (c and d)",
            "this time counts from any step with `mode is alert`",
        ),
        (
            "reach a then b then within 0.5 s c",
            "reach a then b then (c and once within 0.5 s begins a)",
            "this time counts from `b`, not from `a`",
        ),
        (
            "reach a then b then within 3 steps c then d",
            "reach a then b then (c and once within 3 steps begins a) then d",
            "this time counts from `b`, not from `a`",
        ),
        (
            "reach a then b then c then within 0.5 s d",
            "reach a then b then c then (d and once within 0.5 s begins a)",
            "this time counts from `c`, not from `a`",
        ),
        (
            "reach begins a then begins b then within 0.5 s (c or d)",
            "reach begins a then begins b then ((c or d) and once within 0.5 s begins a)",
            "this time counts from `begins b`, not from `begins a`",
        ),
        (
            "reach a and x > 3 then not b then within 0.5 s (c and d)",
            "reach a and x > 3 then not b then (c and d and once within 0.5 s begins (a and x > 3))",
            "this time counts from `not b`, not from `a and x > 3`",
        ),
        (
            "reach begins a and x > 3 then b then within 0.5 s c",
            "reach begins a and x > 3 then b then (c and once within 0.5 s (begins a and x > 3))",
            "this time counts from `b`, not from `begins a and x > 3`",
        ),
        (
            "reach mode is idle then mode is alert then within 0.5 s mode is chase",
            "reach mode is idle then mode is alert then (mode is chase and once within 0.5 s begins mode is idle)",
            "this time counts from `mode is alert`, not from `mode is idle`",
        ),
    ],
)
def test_a_time_after_several_goals_gets_a_note(clause: str, offered: str, title: str) -> None:
    for before in (BEFORE, BEFORE.replace("10 Hz", "varies")):
        if "steps" in clause and "varies" in before:
            continue
        (note,) = (
            item.diagnostic for item in findings_in(block(clause, before=before)) if item.diagnostic.code == "TLT0481"
        )
        assert (note.severity, note.title) == ("note", title)
        assert (note.help or "").split("`")[3] == offered
        assert set(codes(block(offered, before=before))) <= {"TLT0421"}


@pytest.mark.parametrize("first", ["a", "begins a"])
def test_the_offered_clause_counts_from_the_first_goal_where_each_begins_once(first: str) -> None:
    last = "within 2 steps c", "(c and once within 2 steps begins a)"
    typed, offered = (Monitor(compile_text(block(f"reach {first} then b then {goal}"))[0]) for goal in last)
    differs = False
    stretches = [(start, end) for start in range(LENGTH) for end in range(start, LENGTH)]
    for held in product(stretches, repeat=3):
        a, b, c = ([start <= step <= end for step in range(LENGTH)] for start, end in held)
        began = held[0][0]
        expected = any(
            a[i] and b[j] and c[k] and k - began <= 2
            for k in range(LENGTH)
            for j in range(k)
            for i in range(j)
            if first == "a" or i == began
        )
        samples = [dict(zip("abc", map(float, sample), strict=True)) for sample in zip(a, b, c, strict=True)]
        assert accepts(offered, samples) == expected, held
        differs |= accepts(typed, samples) and not expected
    assert differs


def test_the_offered_clause_counts_from_the_latest_beginning() -> None:
    monitor = Monitor(compile_text(block("reach a then b then (c and once within 2 steps begins a)"))[0])
    for trace, expected in (("ab  c", False), ("ab ac", True), ("aba c", True), ("aba  c", False)):
        assert accepts(monitor, [{name: float(name == sample) for name in "abc"} for sample in trace]) == expected


def accepts(monitor: Monitor, samples: list[dict[str, float]]) -> bool:
    monitor.reset()
    return [monitor.step(sample).accepting for sample in samples][-1]


@pytest.mark.parametrize(
    "clause",
    [
        "reach a then within 0.5 s b",
        "reach a then b then c",
        "reach a then within 0.5 s b then c",
        "reach a then within 0.5 s b then within 0.5 s c",
        # The author says where the time begins.
        "reach a then begins b then within 0.5 s c",
        # The first goal comes again.
        "reach a then b then within 0.5 s a",
        "reach a then b then within 0.5 s (a and c)",
        "reach x > 3 then b then within 0.5 s x > 5",
        "reach a then b then a then within 0.5 s c",
        "reach a then b then within 0.5 s (always for 0.3 s c)",
        "reach (eventually a) then b then within 0.5 s c",
        "avoid a then b then within 0.5 s c",
        "reach a then b then within 0.5 s c  // tltlc: allow TLT0481",
    ],
)
def test_other_sequences_get_none(clause: str) -> None:
    assert "TLT0481" not in codes(block(clause, before=BEFORE))
