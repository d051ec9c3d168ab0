"""The sign of a comparison's robustness agrees with its truth, however large or small the numbers are."""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from math import inf, nextafter

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.fuzzing import times
from tests.resolve.helpers import codes, only_spec, resolve_text, robustness_of
from tltlc.expression.evaluate import evaluate
from tltlc.expression.python import compile_expressions
from tltlc.expression.tree import LEAST, Const, Expression, SignalValue, nodes
from tltlc.resolve import units
from tltlc.resolve.margins import robustness
from tltlc.resolve.values import Quantity, constant

FINITE = st.floats(allow_nan=False, allow_infinity=False)
THREE = st.tuples(FINITE, FINITE, FINITE).map(sorted).filter(lambda ends: ends[0] < ends[2])


def signal_quantity(name: str, low: float, high: float) -> Quantity:
    return Quantity(SignalValue(name), units.PLAIN, low, high, name)


def nearby_numbers(number: float, low: float, high: float) -> list[float]:
    """Return a number, its neighbours, the ends, 0 and ``LEAST``, if they are in the range."""
    near = (number, nextafter(number, -inf), nextafter(number, inf), low, high, 0.0, LEAST)
    return [x for x in near if low <= x <= high]


def holds(expression: Expression, x: float, y: float = 0.0) -> bool:
    """Return the truth of an expression; asserts that both evaluators agree on a value in [-1, 1]."""
    result = evaluate(expression, {"x": x, "y": y}, {})
    assert compile_expressions([expression], ("x", "y"), {})[0]((x, y)) == result
    assert -1.0 <= result <= 1.0
    return result > 0.0


@times(250)
@given(THREE, FINITE)
def test_a_threshold_agrees_with_the_exact_comparison(ends: Sequence[float], x: float) -> None:
    low, threshold, high = ends
    side, fixed = signal_quantity("x", low, high), constant(threshold, units.PLAIN)
    for number in [*nearby_numbers(threshold, low, high), min(max(x, low), high)]:
        if threshold < high:
            assert holds(robustness(side, fixed), number) == (Fraction(number) > Fraction(threshold))
        if low < threshold:
            assert holds(robustness(fixed, side), number) == (Fraction(number) < Fraction(threshold))


@times(250)
@given(THREE, THREE, FINITE, FINITE)
def test_two_sides_agree_with_the_exact_comparison(
    of_x: Sequence[float], of_y: Sequence[float], x: float, y: float
) -> None:
    (low, _, high), (least, _, most) = of_x, of_y
    if not low <= most or not high > least:
        return  # the comparison is constant, which is an error
    expression = robustness(signal_quantity("x", low, high), signal_quantity("y", least, most))
    y = min(max(y, least), most)
    for other in {y, *(end for end in (low, high, 0.0) if least <= end <= most)}:
        for number in [*nearby_numbers(other, low, high), min(max(x, low), high)]:
            assert holds(expression, number, other) == (Fraction(number) > Fraction(other))


@given(THREE)
def test_the_robustness_at_the_ends_is_one_and_minus_one(ends: Sequence[float]) -> None:
    low, threshold, high = ends
    if low < threshold < high:
        expression = robustness(signal_quantity("x", low, high), constant(threshold, units.PLAIN))
        assert evaluate(expression, {"x": high}, {}) == 1.0
        assert evaluate(expression, {"x": low}, {}) == -1.0
        assert evaluate(expression, {"x": threshold}, {}) == 0.0


@pytest.mark.parametrize(
    ("declared", "comparison", "sample", "truth"),
    [
        ("signal x in [-1e308, 1e308]", "x > -1e308", {"x": nextafter(-1e308, inf)}, True),
        ("signal x in [-1e308, 1e308]", "x > -1e308", {"x": -1e308}, False),
        ("signal x in [0, 1e300]", "x > 0", {"x": 1e-30}, True),
        ("signal x in [0, 100]", "x > 0", {"x": 5e-324}, True),
        ("signal x in [-100, 0]", "x < 0", {"x": -5e-324}, True),
        ("signal x in [-3, 100]", "x > 0", {"x": 5e-324}, True),
        ("signal x in [-0.5, 100]", "x > 0", {"x": 5e-324}, True),
        ("signal x in [0, 5e-324]", "x > 0", {"x": 5e-324}, True),
        ("signal x in [-1e308, 1e308] signal y in [-1e308, 1e308]", "x > y", {"x": 1e308, "y": -1e308}, True),
        ("signal x in [-1e308, 1e308] signal y in [-1e308, 1e308]", "x > y", {"x": 5e-324, "y": 0.0}, True),
        ("signal x in [-1e308, 1e308] signal y in [-1e308, 1e308]", "x > y", {"x": 0.0, "y": 5e-324}, False),
        ("signal x in [-1e308, 1e308] param p in [-1e308, 1e308] = 0", "x > p", {"x": 5e-324}, True),
        ("signal x: length in [0 m, 1e305 km]", "x > 0 m", {"x": 1e-300}, True),
        ("signal x in [0, 1e300] predicate p in [0, 1] = x / 1e300", "p > 0", {"x": 1e-20}, True),
    ],
)
def test_the_sign_is_right_in_extreme_ranges(
    declared: str, comparison: str, sample: dict[str, float], truth: bool
) -> None:
    spec = only_spec(f"{declared} spec s = F {comparison}")
    (atom,) = spec.atoms
    assert (robustness_of(spec, atom.name, **sample) > 0.0) == truth
    numbers = [node.value for node in nodes(atom.expression) if isinstance(node, Const)]
    assert all(map(math.isfinite, numbers))


def test_robustness_is_scaled_for_a_threshold_at_the_end_of_a_large_range() -> None:
    spec = only_spec("signal x in [-1e308, 1e308] spec s = F x > -1e308")
    assert robustness_of(spec, "x > -1e+308", x=0.0) == 0.5
    assert robustness_of(spec, "x > -1e+308", x=1e308) == 1.0


def test_usual_comparisons_are_scaled_by_a_division_only() -> None:
    spec = only_spec("signal x in [0, 100] spec s = F x > 30 & F x < 100 & F x > 99.9")
    assert all(LEAST not in [n.value for n in nodes(a.expression) if isinstance(n, Const)] for a in spec.atoms)


@pytest.mark.parametrize(
    ("declared", "written"),
    [
        ("signal x in [0, 1e200]", "x * x > 1"),
        ("signal x in [1e200, 1e300]", "x * x > 1"),
        ("signal x in [1e200, 1e300]", "x * x * 0 < 1"),
        ("signal x in [-1e308, 1e308]", "x - 2 * x > 1"),
        ("signal x in [-1e308, 1e308]", "x + 1e308 > 1"),
        ("signal x in [0, 1]", "x * 1e308 * 1e308 < 5"),
        ("signal x in [1e-300, 1]", "1e300 / x > 5"),
        ("signal x in [0, 1e4]", "x^100 > 5"),
        ("signal x in [0, 1e4]", "5 < exp(x)"),
        ("signal x in [0, 1e200]", "clamp(x * x - x * x, -1, 1) > 0.5"),
        ("signal x in [0, 1e200] signal y in [0, 1]", "y > x * x"),
        ("signal x in [0, 1] param p in [0, 1e200] = 1", "p * p > x"),
        ("signal x in [0, 1e200]", "(when x > 1: x * x otherwise: 1) > 2"),
        ("signal x: length in [0 m, 1e200 km]", "x * x > 1 m * 1 m"),
    ],
)
def test_arithmetic_with_too_large_values_is_rejected(declared: str, written: str) -> None:
    assert codes(f"{declared} spec s = F ({written})") == ["TLT0319"]


@pytest.mark.parametrize(
    ("written", "code"),
    [
        ("signal x in [0, inf] spec s = F x * x > 1", "TLT0311"),
        ("signal x in [-1, 1] spec s = F 1 / x > 1", "TLT0311"),
        ("signal x in [-1, 1] spec s = F sqrt(x) > 1", "TLT0311"),
        ("signal x in [0, 1] spec s = F x > 1e308 * 10", "TLT0309"),
        ("signal x: length in [0 m, 1e306 km] spec s = F x > 0", "TLT0109"),
        ("signal x: length in [0 m, 1 m] spec s = F x > 1e306 km", "TLT0109"),
        ("param p: length in [0 m, 1 m] = 1e306 km signal x: length in [0 m, 1 m] spec s = F x > p", "TLT0109"),
    ],
)
def test_other_ranges_and_numbers_keep_their_codes(written: str, code: str) -> None:
    assert codes(written) == [code]


def test_the_help_suggests_smaller_ranges() -> None:
    _, (diagnostic,) = resolve_text("signal x in [0, 1e200] spec s = F x * x > 1")
    assert diagnostic.help == "declare smaller ranges for the signals and params that it is computed from"
