"""TLT0479: values at the beginning or the end of a condition, which are judged at every step."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from functools import cache

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.fuzzing import times
from tests.tools.lint.helpers import RANGES, block, codes, findings_in
from tltlc.automaton.fspa import Fspa
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.monitor.monitor import Monitor
from tltlc.pipeline import compile_text

CODE = "TLT0479"
BEFORE = f"clock 1 Hz\n{RANGES}signal n: int in [0, 9]\nsignal mode: (walk, run)\n"
Sample = tuple[bool, int]
"""The values of a and n at a step."""


def note_on(clause: str) -> Diagnostic:
    findings = findings_in(block(clause, before=BEFORE))
    (note,) = (item.diagnostic for item in findings if item.diagnostic.code == CODE)
    return note


@pytest.mark.parametrize(
    ("rule", "condition"),
    [
        ("x >= value_at(x, begins a) - 5", "a"),
        ("x >= 0.5 * value_at(x, begins (a or b))", "(a or b)"),
        ("n == value_at(n, begins mode is run)", "mode is run"),
        ("value_at(x, begins x > 5) >= y", "x > 5"),
        ("x - value_at(x, ends a) <= 5", "not a"),
        ("abs(x - value_at(previous(x), ends (a and b))) <= 5", "not (a and b)"),
        ("n != value_at(n, ends not a)", "a"),
        ("n != value_at(n, ends mode is run)", "mode is not run"),
        ("n != value_at(n, ends (mode is not run))", "mode is run"),
    ],
)
def test_a_value_that_is_judged_at_every_step_gets_a_note(rule: str, condition: str) -> None:
    for clause in (f"keep {rule}", f"keep c and ({rule})"):
        note = note_on(clause)
        assert note.severity == "note"
        assert f"`keep {condition} implies {rule}`" in (note.help or "")


def test_the_note_says_at_which_steps_it_is_judged() -> None:
    assert note_on("keep x >= value_at(x, begins a) - 5").title == "this is also judged where `a` does not hold"
    assert note_on("keep x >= value_at(x, ends a) - 5").title == "this is also judged while `a`"


def falls_in_stretch(trace: Sequence[Sample]) -> bool:
    """Whether n is less than 2 below its value where a began."""
    begun = next(step for step in reversed(range(len(trace))) if not step or not trace[step - 1][0])
    return not trace[-1][0] or trace[-1][1] >= trace[begun][1] - 2


def falls_after_stretch(trace: Sequence[Sample]) -> bool:
    """Whether n is less than 2 below its value where a ended, or at the first step."""
    ended = next(step for step in reversed(range(len(trace))) if not step or trace[step - 1][0])
    return trace[-1][0] or trace[-1][1] >= trace[ended][1] - 2


@cache
def offered_for(rule: str) -> Fspa:
    """Return the automaton of the clause that the note offers."""
    (offered,) = re.findall(r"`(keep [^`]*)`", note_on(f"keep {rule}").help or "")
    (fspa,) = compile_text(block(offered, before="signal a: bool\nsignal n: int in [0, 9]\n"))
    return fspa


@pytest.mark.parametrize(
    ("rule", "holds"),
    [
        ("n >= value_at(n, begins a) - 2", falls_in_stretch),
        ("n >= value_at(n, ends a) - 2", falls_after_stretch),
    ],
)
@times(200)
@given(st.lists(st.tuples(st.booleans(), st.integers(0, 9)), min_size=1, max_size=14))
def test_the_offered_clause_is_about_one_stretch(
    rule: str, holds: Callable[[Sequence[Sample]], bool], trace: Sequence[Sample]
) -> None:
    monitor, is_kept = Monitor(offered_for(rule)), True
    for step, (a, n) in enumerate(trace):
        is_kept = is_kept and holds(trace[: step + 1])
        assert monitor.step({"a": a, "n": n}).accepting == is_kept


@pytest.mark.parametrize(
    "clause",
    [
        "keep a implies x >= value_at(x, begins a) - 5",
        "keep not a implies x >= value_at(x, ends a) - 5",
        "keep b implies x >= value_at(x, begins a) - 5",
        "keep b or x >= value_at(x, begins a) - 5",
        "keep x >= value_at(x, a) - 5",
        "keep x >= value_at(x, begins a) - value_at(y, begins a)",
        "keep x >= previous(value_at(x, begins a))",
        "keep x >= highest_since(x, begins a) - 5",
        "reach x > value_at(x, begins a) + 5",
        "avoid x < value_at(x, begins a) - 5",
    ],
)
def test_other_clauses_get_none(clause: str) -> None:
    assert CODE not in codes(block(clause, before=BEFORE))
