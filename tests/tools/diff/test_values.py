"""Samples at which two atoms differ."""

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
def test_a_threshold_that_moves_is_found(first: float, second: float) -> None:
    assume(first != second)
    one, other = above(first), above(second)
    found = of(one, other)
    assert found is not None and found.is_judged_otherwise
    sample = dict(found.sample)
    for fspa, value in zip((one, other), found.values, strict=True):
        # What is said is what the monitor of each computes.
        monitor = Monitor(fspa)
        monitor.step(sample)
        assert monitor.values == (value,)


def test_a_scale_that_changes_is_no_other_judgement() -> None:
    found = of(above(5), above(5, scale="20"))
    assert found is not None and not found.is_judged_otherwise
    assert of(above(5), above(5)) is None


def test_a_range_alone_changes_no_value_that_both_take() -> None:
    assert of(above(5), above(5, low=-3, high=30)) is None


def test_an_atom_without_a_value() -> None:
    def atom(body: str) -> Fspa:
        (fspa,) = compile_text(f"signal x in [0, 1]  predicate p in [-1, 1] = {body}  spec s = F p")
        return fspa

    found = of(atom("1 - x"), atom("when x > 0: 1 - x otherwise: 1"))
    assert found is None
    one, other = atom("x"), atom("x")
    assert of(one, other) is None


def test_of_a_bool_only_true_and_false_are_tried() -> None:
    def atom(body: str) -> Fspa:
        (fspa,) = compile_text(f"signal x: bool  predicate p in [-1, 1] = {body}  spec s = F p")
        return fspa

    assert of(atom("2 * x - 1"), atom("2 * x * x - 1")) is None
