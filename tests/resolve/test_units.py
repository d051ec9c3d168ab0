"""Units, types, and the ranges of arithmetic."""

from __future__ import annotations

from math import isclose, pi

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from tests.resolve.helpers import codes, only_spec, resolve_text
from tltlc.expression.evaluate import evaluate
from tltlc.expression.tree import Const, Op
from tltlc.resolve.ranges import range_of
from tltlc.resolve.units import in_si


@pytest.mark.parametrize(
    ("value", "unit", "si"),
    [
        (3, "m", 3),
        (3, "km", 3000),
        (29, "%", 0.29),
        (57, "%", 0.57),
        (180, "deg", pi),
        (2, "min", 120),
        (0.5, "h", 1800),
        (7, "ms", 0.007),
        (35, "cm", 0.35),
        (20, "Hz", 20),
        (1, "rad", 1),
        (4, None, 4),
    ],
)
def test_a_number_is_converted_to_si_units(value: float, unit: str | None, si: float) -> None:
    converted = in_si(value, unit)
    assert converted is not None
    assert converted[0] == si


def test_steps_are_not_a_physical_unit() -> None:
    assert in_si(3, "steps") is None


DECLARED = """
entity e
signal d: length in [0 m, 10 m]
signal t: time in [0 s, 10 s]
signal v: speed in [-10 m/s, 10 m/s]
signal w: angle in [-180 deg, 180 deg]
signal r: ratio
signal n in [0, 4]
"""


@pytest.mark.parametrize(
    "comparison",
    [
        "d > 50 cm",
        "d > 0",
        "v * t > d",
        "v > 3 m/s",
        "v > 3 m / 2 s",
        "v > 20 km/h",
        "v > -20 km/h",
        "t > 0.001 h",
        "w > 90 deg",
        "w < 1 rad",
        "sqrt(d * d) > 2 m",
        "d ^ 2 > 4 m * 1 m",
        "abs(w) < 10 deg",
        "min(d, 3 m, 2 m + d) > 1 m",
        "max(d, 0) > 1 m",
        "clamp(d, 0, 5 m) > 1 m",
        "n * d > 3 m",
        "d / 1 m > n",
        "r + n > 1",
        "tanh(d / 3 m) > 0.5",
        "-d < -200 cm",
        "2 * t > 3 s + 100 ms",
        "r > 20 %",
    ],
)
def test_comparisons_with_fitting_units_are_accepted(comparison: str) -> None:
    assert codes(f"{DECLARED} spec s = F {comparison}") == []


@pytest.mark.parametrize(
    "comparison",
    [
        "d > 3",
        "d > 3 s",
        "d > t",
        "d + t > 3 m",
        "v > 3 m",
        "v * t > t",
        "w > 0.5",
        "tanh(d) > 0.5",
        "exp(t) > 2",
        "n ^ d > 1",
        "d ^ n > 1 m",
        "min(d, t) > 1 m",
        "clamp(d, 0, 5) > 1 m",
        "d * d > 3 m",
        "n > 3 rad",
        "r > 20 Hz",
    ],
)
def test_comparisons_with_other_units_are_rejected(comparison: str) -> None:
    assert codes(f"{DECLARED} spec s = F {comparison}") == ["TLT0305"]


def test_a_signal_named_like_a_unit_shadows_it_except_in_constants() -> None:
    text = "signal h: time in [1 s, 2 s] signal v: speed in [0 km/h, 90 km/h] spec s = F v > 10 m/h"
    spec = only_spec(text)
    (v, h) = spec.signals
    assert (v.high, h.name) == (25.0, "h")
    assert spec.atoms[0].name == "v > 10 / h"


def test_the_message_of_a_wrong_unit_suggests_the_right_one() -> None:
    _, (diagnostic,) = resolve_text("import spatial entity s1 spec s { keep near(s1, close = 3 s) }")
    assert (diagnostic.code, diagnostic.title) == ("TLT0305", "expected a length, found a time")
    assert diagnostic.labels[0].message == "`close` is a length; write `3 m`"
    assert diagnostic.labels[0].source.slice(diagnostic.labels[0].span) == "3 s"


def test_a_signal_may_have_the_name_of_a_unit() -> None:
    spec = only_spec("signal s in [1, 2] signal m in [0, 1] spec t = F m / s > 0.2 & F 3 m / s > 2 m")
    assert [signal.name for signal in spec.signals] == ["m", "s"]


VALUES = st.floats(-20, 20).map(lambda x: round(x, 3))


@given(
    op=st.sampled_from(["+", "-", "*", "/", "^", "min", "max", "neg", "abs", "sqrt", "exp", "tanh", "clamp"]),
    ends=st.lists(st.tuples(VALUES, VALUES), min_size=3, max_size=3),
    places=st.lists(st.floats(0, 1), min_size=3, max_size=3),
)
def test_a_range_contains_every_value(op: str, ends: list[tuple[float, float]], places: list[float]) -> None:
    count = {"neg": 1, "abs": 1, "sqrt": 1, "exp": 1, "tanh": 1, "clamp": 3}.get(op, 2)
    ranges = tuple((min(pair), max(pair)) for pair in ends[:count])
    point = [low + (high - low) * place for (low, high), place in zip(ranges, places, strict=False)]
    try:
        value = evaluate(Op(op, tuple(map(Const, point))), {}, {})  # type: ignore[arg-type]
    except (ArithmeticError, ValueError):
        assume(False)
    assume(not isinstance(value, complex))
    low, high = range_of(op, ranges)
    slack = 1e-9 * max(1.0, abs(value))
    assert low - slack <= value <= high + slack


def test_constants_are_folded_and_params_are_kept() -> None:
    text = "signal x in [0, 9] param p in [1, 2] = 1 predicate q in [0, 1] = x / (3 * (1 + 2)) + 0 * p spec s = F q"
    (atom,) = only_spec(text).atoms
    assert "Const(value=9.0)" in repr(atom.expression)
    assert "ParamValue(name='p')" in repr(atom.expression)


@given(value=st.floats(0.001, 1000))
def test_literals_keep_their_value(value: float) -> None:
    spec = only_spec(f"signal d: length in [0 m, 1000 m] param p: length = {value:.6f} m spec s = F d > 1 m")
    assert spec.params == ()
    text = f"signal x in [0, 2] param p in [0, 2000] = {value:.6f} predicate q in [-1, 1] = tanh(x - p) spec s = F q"
    assert isclose(only_spec(text).params[0].value, round(value, 6))
