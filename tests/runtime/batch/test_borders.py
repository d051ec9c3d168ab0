"""Comparisons in a batch are exact, for numbers of any size and format."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import inf, nextafter

import numpy as np
import pytest
import torch
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.resolve.test_comparison_signs import FINITE, THREE, nearby_numbers, signal_quantity
from tltl_runtime.spec.batch import BatchMonitor
from tltl_runtime.spec.batch.float_formats import fits, narrow
from tltlc import compile_text
from tltlc.automaton.finite.build import build, spec_from_formula
from tltlc.automaton.fspa import Fspa
from tltlc.core.record import replace
from tltlc.expression.tree import Expression
from tltlc.logic import formula as f
from tltlc.resolve import spec, units
from tltlc.resolve.margins import robustness
from tltlc.resolve.values import constant
from tltlc.tools.conformance.borders import EXTREMES, Border

FORMATS = (torch.float64, torch.float32)
NARROW = st.floats(allow_nan=False, allow_infinity=False, width=32)
THREE_NARROW = st.tuples(NARROW, NARROW, NARROW).map(sorted).filter(lambda ends: ends[0] < ends[2])


def automaton(expression: Expression, **ranges: tuple[float, float]) -> Fspa:
    """Return an automaton that accepts after a sample at which the atom holds."""
    signals = tuple(spec.Signal(name, "number", *ends) for name, ends in ranges.items())
    plain = build(spec_from_formula(f.always(f.eventually(f.atom("a")))))
    return replace(plain, signals=signals, atoms=(spec.Atom("a", expression),))


def truths(fspa: Fspa, samples: Sequence[Sequence[float]], dtype: torch.dtype, checked: bool = True) -> list[bool]:
    """Whether the atom holds at each sample; check the type and range of the values."""
    monitor = BatchMonitor(fspa, len(samples), dtype=dtype, checked=checked)
    step = monitor.step(torch.tensor(samples, dtype=torch.float64))
    assert step.values.dtype == dtype
    assert bool((step.values.abs() <= 1.0).all())
    return (step.values[0] > 0.0).tolist()


@settings(max_examples=150, deadline=None)
@given(THREE, FINITE)
def test_a_comparison_with_a_threshold_is_exact_in_float64(ends: Sequence[float], x: float) -> None:
    low, threshold, high = ends
    side, fixed = signal_quantity("x", low, high), constant(threshold, units.PLAIN)
    samples = [[number] for number in (*nearby_numbers(threshold, low, high), min(max(x, low), high))]
    if threshold < high:
        results = truths(automaton(robustness(side, fixed), x=(low, high)), samples, torch.float64)
        assert results == [Fraction(number) > Fraction(threshold) for (number,) in samples]
    if low < threshold:
        results = truths(automaton(robustness(fixed, side), x=(low, high)), samples, torch.float64, checked=False)
        assert results == [Fraction(number) < Fraction(threshold) for (number,) in samples]


@settings(max_examples=150, deadline=None)
@given(THREE_NARROW)
def test_a_comparison_of_float32_numbers_is_exact_in_float32(ends: Sequence[float]) -> None:
    """Thresholds and samples are float32 numbers, so nothing is rounded before the comparison."""
    low, threshold, high = ends
    if not threshold < high:
        return
    expression = robustness(signal_quantity("x", low, high), constant(threshold, units.PLAIN))
    single = np.float32(threshold)
    numbers = (single, np.nextafter(single, np.float32(inf)), np.nextafter(single, np.float32(-inf)), low, high, 0.0)
    samples = [[float(number)] for number in numbers if low <= number <= high]
    results = truths(automaton(expression, x=(low, high)), samples, torch.float32)
    assert results == [number > threshold for (number,) in samples]


@pytest.mark.parametrize("dtype", FORMATS)
@pytest.mark.parametrize("checked", [True, False])
@pytest.mark.parametrize("border", EXTREMES, ids=lambda border: border.comparison(1))
def test_comparisons_in_extreme_ranges_are_exact(border: Border, dtype: torch.dtype, checked: bool) -> None:
    """If a number is too large or too small for the format, everything is computed in float64."""
    (fspa,) = compile_text(f"{border.declaration(1)} spec s = always eventually {border.comparison(1)}")
    numbers = [end for signal in fspa.signals for end in (signal.low, signal.high) if end is not None]
    samples = [list(values) for values in border.values()]
    if dtype == torch.float32 and fits([*numbers, border.threshold or 0.0], dtype):
        samples = [list(map(float, np.float32(sample))) for sample in samples]
    step = BatchMonitor(fspa, len(samples), dtype=dtype, checked=checked).step(np.array(samples))
    assert step.accepting.tolist() == [border.holds(*values) for values in samples]


def test_a_small_number_in_a_large_range_is_not_rounded_to_zero() -> None:
    (fspa,) = compile_text("signal x in [0, 1e300] spec s = F x > 0")
    monitor = BatchMonitor(fspa, 3, dtype=torch.float32)
    step = monitor.step(torch.tensor([[1e-30], [0.0], [nextafter(0.0, 1.0)]], dtype=torch.float64))
    assert step.accepting.tolist() == [True, False, True]
    assert step.values.dtype == torch.float32


def test_a_value_keeps_its_sign_in_a_smaller_format() -> None:
    values = torch.tensor([1e-60, -1e-60, 0.0, -0.0, 0.5, float("nan")], dtype=torch.float64)
    smaller = narrow(values, torch.float32)
    assert smaller.dtype == torch.float32
    assert (smaller > 0.0).tolist() == (values > 0.0).tolist()
    assert (smaller < 0.0).tolist() == (values < 0.0).tolist()
    assert bool(smaller[5].isnan())
