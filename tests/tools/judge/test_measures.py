from __future__ import annotations

import pytest

from tltlc import compile_text
from tltlc.tools.judge.measures import Measure, measure, short_number

SIGNALS = """
import spatial
entity exit
signal x: length in [0 m, 10 m]
signal y: length in [0 m, 10 m]
signal v: speed in [-20 m/s, 20 m/s]
signal t: time in [1 s, 100 s]
signal turn: angle in [-1 rad, 1 rad]
signal heat: number in [0, 8]
signal hot: bool
signal cold: number in [0, 8]
signal phase: int in [0, 5]
signal floor: int in [0, 9]
signal mode: (idle, alert)
param most: length in [1 m, 5 m] = 3 m
"""
SAMPLE = {
    "x": 6.5,
    "y": 2.0,
    "v": -3.0,
    "t": 4.0,
    "turn": 0.5,
    "heat": 6.0,
    "hot": 1.0,
    "cold": -1.0,
    "phase": 3.0,
    "floor": 7.0,
    "mode": 1.0,
    "distance(exit)": 2.0,
}


def measured(formula: str) -> Measure | None:
    (fspa,) = compile_text(f"{SIGNALS}spec s {{ reach {formula} }}")
    return measure(fspa, 0, SAMPLE)


@pytest.mark.parametrize(
    ("formula", "expected"),
    [
        ("x < 5 m", Measure("x", 6.5, 1.5, "m")),
        ("x >= 7 m", Measure("x", 6.5, 0.5, "m")),
        ("7 m <= x", Measure("x", 6.5, 0.5, "m")),
        ("abs(v) > 4 m/s", Measure("abs(v)", 3.0, 1.0, "m/s")),
        ("v > 0", Measure("v", -3.0, 3.0, "m/s")),
        ("v < 0 m/s", Measure("v", -3.0, 3.0, "m/s")),
        ("x / t > 2 m/s", Measure("x / t", 1.625, 0.375, "m/s")),
        ("turn < 0.25 rad", Measure("turn", 0.5, 0.25, "rad")),
        ("heat / 2 > 2", Measure("heat / 2", 3.0, 1.0, "")),
        ("x < most", Measure("x", 6.5, 3.5, "m")),
        ("x > y", Measure("x", None, 4.5, "m")),
        ("phase == 5", Measure("phase", 3.0, 2.0, "")),
        ("phase != 3", Measure("phase", 3.0, 0.0, "")),
        ("phase == 0", Measure("phase", 3.0, 3.0, "")),
        ("floor - phase == 0", Measure("floor - phase", 4.0, 4.0, "")),
        ("phase == floor", Measure("phase", None, 4.0, "")),
        ("x < y + 1 m", Measure("y + 1", None, 3.5, "m")),
    ],
)
def test_the_sides_of_a_comparison_are_measured_in_their_unit(formula: str, expected: Measure) -> None:
    assert measured(formula) == expected


@pytest.mark.parametrize(
    ("value", "gap", "text"),
    [
        (0.1 + 0.2, 0.1 + 0.2 - 0.3, "x is 0.30000000000000004 m"),
        (2.9996, 0.0004, "x is 2.9996 m"),
        (2.9996, 0.9996, "x is 3 m"),
        (3.0, 0.0, "x is 3 m"),
        (1234.0, 0.25, "x is 1234 m"),
        (1234.25, 0.25, "x is 1234.2 m"),
    ],
)
def test_a_value_beside_its_border_has_enough_digits(value: float, gap: float, text: str) -> None:
    assert Measure("x", value, gap, "m").text == text


@pytest.mark.parametrize("formula", ["hot", "near(exit)", "heat / 2 > 0", "sqrt(cold) > 1", "mode is idle"])
def test_an_atom_without_measurable_sides_has_no_measure(formula: str) -> None:
    assert measured(formula) is None


@pytest.mark.parametrize(
    ("value", "text"),
    [(3.12345, "3.12"), (-0.0, "0"), (12.0, "12"), (1234.5, "1234"), (-1e5, "-100000"), (2.5e6, "2.5e+06")],
)
def test_a_short_number_has_three_digits_and_all_those_before_the_point(value: float, text: str) -> None:
    assert short_number(value) == text
