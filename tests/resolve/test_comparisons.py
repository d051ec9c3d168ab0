"""Comparisons: their robustness, the atoms that they share, and the errors of invalid ones."""

from __future__ import annotations

from math import isclose

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.resolve.helpers import codes, formula, only_spec, resolve_text, robustness_of

NUMBERS = st.integers(-50, 50)


@given(c=NUMBERS, holding=st.integers(1, 50), failing=st.integers(0, 50), x=st.floats(0, 1), op=st.sampled_from("<>"))
def test_robustness_is_one_at_the_ends_and_zero_at_the_threshold(
    c: int, holding: int, failing: int, x: float, op: str
) -> None:
    low, high = (c - failing, c + holding) if op == ">" else (c - holding, c + failing)
    spec = only_spec(f"signal x in [{low}, {high}] spec s = F x {op} {c}")
    name = f"x {op} {c}"
    assert [atom.name for atom in spec.atoms] == [name]
    good, bad = (high, low) if op == ">" else (low, high)
    assert robustness_of(spec, name, x=good) == 1
    assert robustness_of(spec, name, x=c) == 0
    assert robustness_of(spec, name, x=bad) == (0 if bad == c else -1)
    at = low + (high - low) * x
    expected = (at - c) / (good - c) if (at > c) == (op == ">") else -abs(at - c) / abs(bad - c) if at != c else 0.0
    actual = robustness_of(spec, name, x=at)
    assert isclose(actual, expected, abs_tol=1e-12)
    assert (actual > 0) == (at > c if op == ">" else at < c)


@pytest.mark.parametrize(
    ("written", "resolved_form"),
    [
        ("x >= 2", "!(x < 2)"),
        ("x <= 2", "!(x > 2)"),
        ("2 < x", "(x > 2)"),
        ("2 >= x", "!(x > 2)"),
        ("x > y", "(x > y)"),
        ("y < x", "(x > y)"),
        ("x <= y", "!(x > y)"),
        ("y >= x", "!(x > y)"),
        ("x + y > 3", "(x + y > 3)"),
        ("2 * (x + y) > 3", "(2 * (x + y) > 3)"),
        ("x - (y - 1) > 0.5", "(x - (y - 1) > 0.5)"),
        ("x > 1 + 1", "(x > 2)"),
        ("-x > -200 %", "(-x > -2)"),
    ],
)
def test_equivalent_comparisons_have_the_same_form(written: str, resolved_form: str) -> None:
    text = formula(f"signal x in [0, 4] signal y in [0, 4] spec s = F ({written})")
    assert text in (f"F {resolved_form}", f"F{resolved_form}", f"F({resolved_form})")


def test_opposite_comparisons_share_an_atom() -> None:
    spec = only_spec("signal health: ratio spec s = G health >= 50 % & F health < 0.5")
    assert [atom.name for atom in spec.atoms] == ["health < 0.5"]
    assert str(spec.formula) == "G !(health < 0.5) & F(health < 0.5)"


@given(x=st.floats(0, 4), y=st.floats(-1, 2))
def test_two_sides_are_compared_by_their_difference(x: float, y: float) -> None:
    spec = only_spec("signal x in [0, 4] signal y in [-1, 2] spec s = F x > y")
    difference = x - y
    expected = difference / 5 if difference > 0 else difference / 2
    assert isclose(robustness_of(spec, "x > y", x=x, y=y), expected, abs_tol=1e-12)


def test_robustness_uses_the_range_of_a_param() -> None:
    spec = only_spec("signal x in [0, 4] param p in [1, 2] = 1.5 spec s = F x > p")
    assert spec.params[0].value == 1.5
    assert robustness_of(spec, "x > p", x=4) == 2.5 / 3
    assert robustness_of(spec, "x > p", x=0) == -0.75


def test_robustness_uses_the_declared_range_of_a_predicate() -> None:
    spec = only_spec("signal x in [0, 4] predicate p in [-1, 1] = x / 2 - 1 spec s = F p > 0.5")
    assert [atom.name for atom in spec.atoms] == ["p > 0.5"]
    assert robustness_of(spec, "p > 0.5", x=4) == 1
    assert robustness_of(spec, "p > 0.5", x=0) == -1


@pytest.mark.parametrize(
    ("declared", "written", "code"),
    [
        ("in [0, 1]", "x > 1", "TLT0310"),
        ("in [0, 1]", "x < 0", "TLT0310"),
        ("in [0, 1]", "x >= 0", "TLT0310"),
        ("in [0, 1]", "x <= 1", "TLT0310"),
        ("in [0, 1]", "x > -1", "TLT0310"),
        ("in [0, inf]", "x > -1", "TLT0310"),
        ("in [0, 1]", "3 > 2", "TLT0310"),
        ("in [0, inf]", "x > 1", "TLT0311"),
        ("in [0, inf]", "x < 1", "TLT0311"),
        ("in [0, inf]", "x > 0", "TLT0311"),
        ("in [-inf, 0]", "x < 0", "TLT0311"),
        (": number", "x > 1", "TLT0311"),
    ],
)
def test_invalid_comparisons_are_rejected(declared: str, written: str, code: str) -> None:
    assert codes(f"signal x {declared} spec s = F ({written})") == [code]


@pytest.mark.parametrize(
    ("written", "is_percentage"),
    [
        ("x > 50", True),
        ("x >= 100", True),
        ("x < 100", True),
        ("x > 100", False),
        ("x <= 100", False),
        ("x < 1.5", False),
        ("x > 200", False),
    ],
)
def test_a_percentage_is_suggested_if_it_would_be_valid(written: str, is_percentage: bool) -> None:
    text = f"signal x: ratio spec s = F ({written}"
    _, (diagnostic,) = resolve_text(text + ")")
    assert (f"write `{written} %`" in (diagnostic.help or "")) == is_percentage
    assert not is_percentage or codes(text + " %)") == []


@pytest.mark.parametrize("written", ["x > 0", "x < 1", "x >= 1", "x <= 0"])
def test_a_threshold_may_be_an_end_of_the_range(written: str) -> None:
    assert codes(f"signal x in [0, 1] spec s = F ({written})") == []


def test_a_bool_signal_is_an_atom_with_robustness_one_or_minus_one() -> None:
    spec = only_spec("signal a: bool signal at(x: entity): bool entity e spec s = F a & G at(e)")
    assert [atom.name for atom in spec.atoms] == ["a", "at(e)"]
    assert (robustness_of(spec, "a", a=1.0), robustness_of(spec, "a", a=0.0)) == (1.0, -1.0)
    assert [(signal.low, signal.high) for signal in spec.signals] == [(0.0, 1.0)] * 2
