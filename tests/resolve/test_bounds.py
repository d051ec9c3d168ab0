"""Bounded operators have the right meaning on all short traces."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.logic.strategies import traces
from tests.resolve.helpers import codes, formula, only_spec, resolve_text
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.logic.oracle import holds
from tltlc.pipeline import compile_text

DECLARED = "clock 20 Hz signal a: bool spec s = "


@given(trace=traces(("a",), max_length=8), low=st.integers(0, 4), extra=st.integers(0, 4))
def test_past_the_end_eventually_is_false_and_always_is_true(
    trace: tuple[frozenset[str], ...], low: int, extra: int
) -> None:
    window = trace[low : low + extra + 1]
    eventually = only_spec(f"{DECLARED} F[{low},{low + extra}] a").formula
    always = only_spec(f"{DECLARED} G[{low},{low + extra}] a").formula
    assert holds(eventually, trace) == any("a" in sample for sample in window)
    assert holds(always, trace) == all("a" in sample for sample in window)


@given(trace=traces(("a",), max_length=8), n=st.integers(0, 8))
def test_next_after_looks_that_many_steps_ahead(trace: tuple[frozenset[str], ...], n: int) -> None:
    strong = only_spec(f"{DECLARED} next after {n} steps a").formula
    weak = only_spec(f"{DECLARED} weak_next after {n} steps a").formula
    assert holds(strong, trace) == (n < len(trace) and "a" in trace[n])
    assert holds(weak, trace) == (n >= len(trace) or "a" in trace[n])


@pytest.mark.parametrize(
    ("words", "brackets"),
    [
        ("eventually within 3 steps a", "F[0,3] a"),
        ("always for 3 steps a", "G[0,2] a"),
        ("eventually within 0 steps a", "a"),
        ("next after 0 steps a", "a"),
        ("eventually within 0.15 s a", "F[0,3] a"),
        ("eventually within 151 ms a", "F[0,4] a"),
        ("always for 1 s a", "G[0,19] a"),
        ("F[0.05 s, 0.1 s] a", "F[1,2] a"),
        ("always for 0.01 min a", "G[0,11] a"),
        ("next after 1 step a", "X a"),
    ],
)
def test_bounds_in_words_and_seconds_equal_bounds_in_brackets(words: str, brackets: str) -> None:
    assert formula(DECLARED + words) == formula(DECLARED + brackets)


@pytest.mark.parametrize(("clock", "steps"), [("2 Hz", "3"), ("20 Hz", "30"), ("7 Hz", "11"), ("2 s", "1")])
def test_a_fraction_of_steps_gets_the_time_and_its_steps(clock: str, steps: str) -> None:
    before = f"clock {clock} signal a: bool spec s ="
    (diagnostic,) = resolve_text(f"{before} F[0,1.5] a")[1]
    assert diagnostic.help is not None and not diagnostic.fixes
    assert f"`1.5 s`, which is {steps} step" in diagnostic.help
    assert formula(f"{before} F[0,1.5 s] a") == formula(f"{before} F[0,{steps}] a")


@pytest.mark.parametrize("period", [0.05, 0.1, 0.02, 0.15, 1 / 60, 1 / 30])
@given(n=st.integers(0, 200))
def test_whole_multiples_of_the_period_are_not_rounded_up(period: float, n: int) -> None:
    text = f"clock {period:.17f} s signal a: bool spec s {{ limit {(n + 1) * period:.17f} s keep a }}"
    assert only_spec(text).limit_steps == n + 1


def test_a_bound_that_is_too_long_is_an_error() -> None:
    for bound in ("F[0,1000000000]", "G[999999999,1000000000]", "F[0,400] F[0,400]"):
        assert codes(f"signal a: bool spec s = next (a until {bound} a)") == ["TLT0315"]


def test_a_long_bound_with_a_timer_is_no_error() -> None:
    for bound in ("F[0,1000000000]", "G[999999999,1000000000]"):
        assert codes(f"signal a: bool spec s = {bound} a") == []


def test_step_and_steps_are_the_same_unit() -> None:
    text = 'signal a: bool spec s = {} test "t" for s {{ step a expect progress >= 0.5 step a expect satisfied }}'
    for singular, plural in (("F[0,1 step] a", "F[0,1 steps] a"), ("F within 1 step a", "F within 1 steps a")):
        assert only_spec(text.format(singular)).formula == only_spec(text.format(plural)).formula
    assert only_spec("signal a: bool spec s { limit 1 step keep a }").limit_steps == 1


def test_the_error_about_a_bound_names_the_one_of_its_own_spec() -> None:
    text = (
        "signal a: bool\nsignal b: bool\n"
        "spec small { require next after 90 steps b }\n"
        "spec large { keep a implies next after 90 steps b }\n"
    )
    with pytest.raises(TltlError) as caught:
        compile_text(text)
    (problem,) = caught.value.diagnostics
    assert problem.code == "TLT0501"
    assert problem.labels[0].span.start > text.index("spec large")


@pytest.mark.parametrize("clock", ["clock 60 Hz", "clock 1 Hz", "clock varies"])
@pytest.mark.parametrize(
    ("bounded", "unbounded"),
    [
        ("eventually within 60 s (a then within 5 s b)", "(a then within 5 s b)"),
        ("eventually within 60 s eventually a", "eventually a"),
        ("always for 60 s always a", "always a"),
    ],
)
def test_a_bound_before_the_same_operator_without_one_is_left_out(clock: str, bounded: str, unbounded: str) -> None:
    names = f"{clock}\nsignal a: bool\nsignal b: bool\n"
    (one,), (other,) = (compile_text(f"{names}spec s {{ require {text} }}") for text in (bounded, unbounded))
    assert one.formula == other.formula
