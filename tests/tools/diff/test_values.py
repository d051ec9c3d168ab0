"""Samples on which two atoms differ."""

from __future__ import annotations

from hypothesis import assume, given, settings
from hypothesis import strategies as st

from tltlc import compile_text
from tltlc.automaton.fspa import Fspa
from tltlc.monitor import Monitor
from tltlc.tools.diff.values import Apart, apart, meaning

TENTHS = st.integers(1, 99).map(lambda number: number / 10)


def above(threshold: float, low: float = 0, high: float = 10, scale: str = "") -> Fspa:
    text = f"signal x in [{low}, {high}]  param t in [0, 10] = {threshold}\n"
    text += f"predicate above in [-1, 1] = clamp((x - t) / {scale or '10'}, -1, 1)  spec up = F above"
    (fspa,) = compile_text(text)
    return fspa


def of(one: Fspa, other: Fspa) -> Apart | None:
    return apart(meaning(one, 0), meaning(other, 0))


@settings(max_examples=60, deadline=None)
@given(TENTHS, TENTHS)
def test_a_sample_is_found_for_a_moved_threshold(first: float, second: float) -> None:
    assume(first != second)
    one, other = above(first), above(second)
    difference = of(one, other)
    assert difference is not None and difference.is_judged_otherwise
    sample = dict(difference.sample)
    for fspa, value in zip((one, other), difference.values, strict=True):
        # The reported values are the values that each monitor computes.
        monitor = Monitor(fspa)
        monitor.step(sample)
        assert monitor.values == (value,)


def test_another_scale_changes_values_but_no_truth() -> None:
    difference = of(above(5), above(5, scale="20"))
    assert difference is not None and not difference.is_judged_otherwise
    assert of(above(5), above(5)) is None


def test_another_range_changes_no_common_value() -> None:
    assert of(above(5), above(5, low=-3, high=30)) is None


def test_equal_atoms_have_no_sample() -> None:
    def atom(body: str) -> Fspa:
        (fspa,) = compile_text(f"signal x in [0, 1]  predicate p in [-1, 1] = {body}  spec s = F p")
        return fspa

    difference = of(atom("1 - x"), atom("when x > 0: 1 - x otherwise: 1"))
    assert difference is None
    one, other = atom("x"), atom("x")
    assert of(one, other) is None


def test_only_true_and_false_are_tried_for_a_bool() -> None:
    def atom(body: str) -> Fspa:
        (fspa,) = compile_text(f"signal x: bool  predicate p in [-1, 1] = {body}  spec s = F p")
        return fspa

    assert of(atom("2 * x - 1"), atom("2 * x * x - 1")) is None
