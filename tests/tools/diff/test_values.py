"""Samples at which two atoms have different values."""

from __future__ import annotations

from hypothesis import assume, given
from hypothesis import strategies as st

from tests.fuzzing import times
from tltlc import compile_text
from tltlc.automaton.fspa import Fspa
from tltlc.monitor import Monitor
from tltlc.tools.diff.values import ValueDifference, meaning, value_difference

TENTHS = st.integers(1, 99).map(lambda number: number / 10)


def above(threshold: float, low: float = 0, high: float = 10, scale: str = "") -> Fspa:
    text = f"signal x in [{low}, {high}]  param t in [0, 10] = {threshold}\n"
    text += f"predicate above in [-1, 1] = clamp((x - t) / {scale or '10'}, -1, 1)  spec up = F above"
    (fspa,) = compile_text(text)
    return fspa


def difference_of(one: Fspa, other: Fspa) -> ValueDifference | None:
    return value_difference(meaning(one, 0), meaning(other, 0))


@times(25)
@given(TENTHS, TENTHS)
def test_a_sample_is_found_for_a_moved_threshold(first: float, second: float) -> None:
    assume(first != second)
    one, other = above(first), above(second)
    difference = difference_of(one, other)
    assert difference is not None and difference.differs_in_truth
    sample = dict(difference.sample)
    for fspa, value in zip((one, other), difference.values, strict=True):
        # The reported values are the values that each monitor computes.
        monitor = Monitor(fspa)
        monitor.step(sample)
        assert monitor.values == (value,)


def test_another_scale_changes_values_but_no_truth() -> None:
    difference = difference_of(above(5), above(5, scale="20"))
    assert difference is not None and not difference.differs_in_truth
    assert difference_of(above(5), above(5)) is None


def test_another_range_changes_no_common_value() -> None:
    assert difference_of(above(5), above(5, low=-3, high=30)) is None


def test_equal_atoms_have_no_sample() -> None:
    def atom(body: str) -> Fspa:
        (fspa,) = compile_text(f"signal x in [0, 1]  predicate p in [-1, 1] = {body}  spec s = F p")
        return fspa

    difference = difference_of(atom("1 - x"), atom("when x > 0: 1 - x otherwise: 1"))
    assert difference is None
    one, other = atom("x"), atom("x")
    assert difference_of(one, other) is None


def test_only_true_and_false_are_tried_for_a_bool() -> None:
    def atom(body: str) -> Fspa:
        (fspa,) = compile_text(f"signal x: bool  predicate p in [-1, 1] = {body}  spec s = F p")
        return fspa

    assert difference_of(atom("2 * x - 1"), atom("2 * x * x - 1")) is None
