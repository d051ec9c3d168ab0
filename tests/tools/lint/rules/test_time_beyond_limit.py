"""TLT0444: times that the limit does not leave room for."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.fuzzing import times
from tests.tools.lint.helpers import accepted_traces, codes, findings_in

CLAUSES = [
    "require eventually within {} s a",
    "keep a implies eventually within {} s b",
    "reach a then within {} s b",
    "avoid a then within {} s b",
    "keep within {} s of a, b",
    "keep a implies once within {} s b",
    "keep a implies always for {} s b",
    "keep a implies historically for {} s b",
]


def text_of(clause: str, clock: str = "10 Hz", limit: str = "10 s") -> str:
    return f"clock {clock} signal a: bool signal b: bool\nspec s {{ judge at limit limit {limit} {clause} }}\n"


def reports(clause: str, **settings: str) -> bool:
    return "TLT0444" in codes(text_of(clause, **settings))


@pytest.mark.parametrize("clause", CLAUSES)
def test_a_time_as_long_as_the_limit_is_noted(clause: str) -> None:
    assert reports(clause.format(10)) and reports(clause.format(20))
    assert not reports(clause.format(9))
    assert not reports(clause.format(20), clock="varies", limit="100 steps")
    assert not reports(clause.format(20), limit="21 s")


def test_the_last_step_decides() -> None:
    # An episode of 100 steps ends 9.9 s after its first step.
    assert reports("require eventually within 9.9 s a") and not reports("require eventually within 9.8 s a")
    # `for` leaves out the end of its time.
    assert reports("keep a implies always for 10 s b") and not reports("keep a implies always for 9.9 s b")
    assert reports("keep a implies F[0,99] b") and not reports("keep a implies F[0,98] b")
    assert reports("keep a implies G[0,99] b") and not reports("keep a implies G[0,98] b")


def test_infinite_traces_and_specs_without_a_limit_are_left_out() -> None:
    assert not reports("semantics infinite keep a implies eventually within 20 s b")
    text = "clock 10 Hz signal a: bool\nspec s { require eventually within 20 s a }\n"
    assert "TLT0444" not in codes(text)


def test_the_note_on_the_first_seconds_is_left_out() -> None:
    assert "TLT0442" not in codes(text_of("require always for 20 s a"))


@times(40)
@given(st.sampled_from(CLAUSES), st.integers(1, 5), st.integers(2, 4))
def test_an_episode_is_judged_the_same_without_the_time(clause: str, seconds: int, limit: int) -> None:
    text = text_of(clause.format(seconds), "1 Hz", f"{limit} s")
    found = [finding.diagnostic for finding in findings_in(text) if finding.diagnostic.code == "TLT0444"]
    without = clause.replace(" within {} s of a, b", " a implies eventually b")
    without = without.replace(" within {} s", "").replace(" for {} s", "")
    same = accepted_traces(text, "ab", limit) == accepted_traces(text_of(without, "1 Hz"), "ab", limit)
    assert same == bool(found)
