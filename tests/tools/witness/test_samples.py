"""Samples at which atoms are true or false."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

import tltlc
from tests.fuzzing import times
from tltlc.monitor import Monitor
from tltlc.tools.witness.samples import MissingSample, SampleFinder, UnsatisfiedLiterals, csv_text, samples


@pytest.mark.parametrize(
    ("declarations", "formula"),
    [
        ("import spatial  entity e", "F near(e) & G !near(e, close = 3 m) | F facing(e, 2 deg)"),
        ("import spatial", "F inside_box(1 m, 2 m, 3 m, 4 m, 5 m, 5.5 m)"),
        (
            "import core  signal x: number  signal y: number",
            "F above(x, 0.1, 2e-7) & F about(x, y, 0.001) & F less(x, y, 0.5)",
        ),
        ("signal x in [0, 1]", "F x > 0.9995"),
        ("signal n: int in [0, 1000]", "F n == 777 & F n > 998 & F n == 3"),
        ("signal n: int in [0, 9]  signal m: int in [0, 9]", "F n + m == 17 & F n - m == 8"),
        ("signal mode: (idle, alert, chase)", "F mode is idle & F mode is alert & F mode is chase"),
        ("signal v in [0, 60]  signal w: bool", "F v * v > 35 * 35 & F v * w > 59 & F w"),
        ("signal x in [0, 100]  predicate narrow = clamp(1 - 40 * abs(x - 37.123), -1, 1)", "F narrow"),
        (
            "signal x in [-1, 1]  signal y in [-1, 1]  predicate ring = clamp(0.01 - abs(x^2 + y^2 - 0.5), -1, 1)",
            "F ring",
        ),
    ],
)
def test_each_atom_is_made_true_and_false(declarations: str, formula: str) -> None:
    (fspa,) = tltlc.compile_text(f"{declarations}\nspec s = {formula}")
    finder = SampleFinder(fspa)
    for index, atom in enumerate(fspa.atoms):
        for holds in (True, False):
            sample = finder.sample_for_literals(((index, holds),))
            assert isinstance(sample, dict), atom.name
            assert (atom.name in finder.letter_of(sample)) == holds


@times(50)
@given(st.lists(st.integers(1, 99), min_size=1, max_size=4, unique=True), st.data())
def test_values_between_thresholds_are_found(thresholds: list[int], data: st.DataObject) -> None:
    formula = " & ".join(f"F x > {threshold / 100}" for threshold in thresholds)
    (fspa,) = tltlc.compile_text(f"signal x in [0, 1]  spec s = {formula}")
    literals = tuple((index, data.draw(st.booleans())) for index in range(len(thresholds)))
    above = [threshold for threshold, (_, holds) in zip(thresholds, literals, strict=True) if holds]
    below = [threshold for threshold, (_, holds) in zip(thresholds, literals, strict=True) if not holds]
    sample = SampleFinder(fspa).sample_for_literals(literals)
    if max(above, default=0) < min(below, default=100):
        assert isinstance(sample, dict)
        monitor = Monitor(fspa)
        monitor.step(sample)
        assert [value > 0 for value in monitor.values] == [holds for _, holds in literals]
    else:
        assert isinstance(sample, UnsatisfiedLiterals)
        (low, low_holds), (high, high_holds) = sorted(sample.literals, key=lambda literal: thresholds[literal[0]])
        assert not low_holds and high_holds and thresholds[low] < thresholds[high]


def test_the_values_of_integers_and_enums_are_whole_numbers() -> None:
    text = "signal n: int in [0, 9]  signal mode: (idle, alert, chase)  signal x in [0, 9]\n"
    (fspa,) = tltlc.compile_text(text + "spec s = F (n == 4 & x > 2.5) & F mode is alert & F n + x > 17 & F n != 5")
    finder = SampleFinder(fspa)
    for index in range(len(fspa.atoms)):
        for holds in (True, False):
            sample = finder.sample_for_literals(((index, holds),))
            assert isinstance(sample, dict)
            assert sample["n"].is_integer() and sample["mode"].is_integer()


def test_an_enum_has_no_value_besides_its_own() -> None:
    (fspa,) = tltlc.compile_text("signal mode: (idle, alert)\nspec s = F (mode is not idle & mode is not alert)")
    literals = tuple((index, False) for index in range(2))
    assert isinstance(SampleFinder(fspa).sample_for_literals(literals), UnsatisfiedLiterals)


def test_exclusive_atoms_do_not_hold_together() -> None:
    text = "signal a: bool  signal b: bool  exclusive a, b  spec s = F a & F b"
    (fspa,) = tltlc.compile_text(text)
    finder = SampleFinder(fspa)
    assert isinstance(finder.sample_for_letter(frozenset({"a", "b"})), UnsatisfiedLiterals)
    assert finder.sample_for_letter(frozenset({"a"})) == {"a": 1.0, "b": 0.0}


def test_a_trace_of_letters_becomes_csv_or_names_an_obstacle() -> None:
    (fspa,) = tltlc.compile_text("signal x in [0, 1]  signal seen: bool  spec s = F x > 0.5 & F x > 0.25 & F seen")
    low, high = frozenset({"x > 0.25"}), frozenset({"x > 0.5", "x > 0.25", "seen"})
    trace_samples = samples(fspa, (low, high))
    assert not isinstance(trace_samples, MissingSample)
    assert csv_text(fspa, trace_samples).splitlines()[0] == "x,seen"
    assert [line.split(",")[1] for line in csv_text(fspa, trace_samples).splitlines()[1:]] == ["false", "true"]
    missing = samples(fspa, (low, frozenset({"x > 0.5"})))
    assert isinstance(missing, MissingSample)
    assert (missing.step, missing.obstacle.text(fspa)) == (2, "`x > 0.5` and not `x > 0.25`")
