"""TLT0450: `always for` and `time_holding` with the same time, which need different numbers of steps."""

from __future__ import annotations

import re

import pytest

from tests.tools.lint.helpers import SIGNALS, block, findings_in, labelled_texts_in_block
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.monitor import Monitor
from tltlc.pipeline import compile_text


def notes(text: str) -> list[Diagnostic]:
    return [finding.diagnostic for finding in findings_in(text) if finding.diagnostic.code == "TLT0450"]


def steps_needed(clause: str, clock: str) -> int:
    """Return after how many steps with `a`, and one without, a trace is first accepted."""
    (fspa,) = compile_text(block(clause, before=f"clock {clock}\n{SIGNALS}"))
    for count in range(1, 99):
        monitor = Monitor(fspa)
        for holds in (*[True] * count, False):
            step = monitor.step({"a": float(holds), "b": 0.0, "c": 0.0})
        if step.accepting:
            return count
    raise AssertionError(clause)


@pytest.mark.parametrize(
    ("time", "clock", "op", "counts", "offered"),
    [
        ("2 s", "10 Hz", ">=", (20, 21), "1.9 s"),
        ("2 s", "10 Hz", ">", (20, 22), "1.9 s"),
        ("250 ms", "10 Hz", ">=", (3, 4), "200 ms"),
        ("250 ms", "10 Hz", ">", (3, 4), "200 ms"),
        ("1 s", "30 Hz", ">=", (30, 31), "0.96 s"),
        ("1 s", "60 Hz", ">", (60, 62), "0.98 s"),
    ],
)
def test_the_note_counts_the_steps(time: str, clock: str, op: str, counts: tuple[int, int], offered: str) -> None:
    stretch, comparison, same = f"always for {time} a", f"time_holding(a) {op} {time}", f"time_holding(a) >= {offered}"
    clauses = (f"keep b implies {stretch}", f"keep c implies {comparison}")
    (note,) = notes(block(*clauses, before=f"clock {clock}\n{SIGNALS}"))
    assert [int(number) for label in note.labels[::-1] for number in re.findall(r"\d+(?= steps|,)", label.message)] == [
        *counts
    ]
    assert f"if both mean {counts[0]} steps, write `{same}`; " in (note.help or "")
    goals = [f"require {stretch}", f"reach {comparison}", f"reach {same}"]
    assert [steps_needed(goal, clock) for goal in goals] == [*counts, counts[0]]
    clauses = (f"keep b implies {stretch}", f"keep c implies {same}")
    assert labelled_texts_in_block("TLT0450", *clauses, before=f"clock {clock}\n{SIGNALS}") == []


@pytest.mark.parametrize(
    "clauses",
    [
        ("keep b implies always for 1 s a", "avoid time_holding(a) > 1 s"),
        ("keep b implies always for 1 s a", "keep c implies time_holding((a)) > 1000 ms"),
        ("keep b implies always for 10 steps a", "reach time_holding(a) >= 1 s"),
        ("keep (c implies always for 1 s (not a)) and (b implies time_holding(not a) >= 1 s)",),
    ],
)
def test_the_two_may_stand_anywhere_in_a_spec(clauses: tuple[str, ...]) -> None:
    assert len(labelled_texts_in_block("TLT0450", *clauses, before=f"clock 10 Hz\n{SIGNALS}")) == 1


@pytest.mark.parametrize(
    "clauses",
    [
        ("keep b implies always for 1 s a", "keep c implies time_holding(a) >= 2 s"),
        ("keep b implies always for 1 s a", "keep c implies time_holding(b) >= 1 s"),
        ("keep b implies eventually within 1 s a", "keep c implies time_holding(a) >= 1 s"),
        ("keep b implies always for 1 s a", "keep c implies time_since(a) >= 1 s"),
        ("keep b implies always for 1 s a", "keep c implies time_holding(a) < 1 s"),
        ("keep b implies always for 0.1 s a", "keep c implies time_holding(a) >= 0.1 s"),
        ("keep b implies always for 20 s a", "keep c implies time_holding(a) >= 20 s"),
        ("keep b implies always for 1 s a", "keep c implies time_holding(a) >= 1 s  // tltlc: allow TLT0450"),
    ],
)
def test_other_times_and_conditions_get_no_note(clauses: tuple[str, ...]) -> None:
    assert labelled_texts_in_block("TLT0450", *clauses, before=f"clock 10 Hz\n{SIGNALS}") == []


def test_where_the_clock_varies_is_no_note() -> None:
    clauses = ("keep begins b implies always for 1 s a", "keep c implies time_holding(a) >= 1 s")
    assert labelled_texts_in_block("TLT0450", *clauses, before=f"clock varies\n{SIGNALS}") == []
