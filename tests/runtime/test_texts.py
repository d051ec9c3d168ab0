"""Numbers and lines as printed for people."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tltl_runtime.support.number_text import column, counted, listed, number, percent, share


@pytest.mark.parametrize(
    ("value", "said"), [(0.0, "0.00"), (0.001, "0.01"), (0.994, "0.99"), (0.996, "0.99"), (1.0, "1.00"), (0.5, "0.50")]
)
def test_shares(value: float, said: str) -> None:
    assert share(value) == said
    assert percent(value) == f"{round(100 * float(said))}%"


@pytest.mark.parametrize(
    ("count", "total", "said"),
    [
        (1, 25, "1 of 25 episodes"),
        (1, 26, "1 of 26 episodes (4%)"),
        (299, 300, "299 of 300 episodes (99%)"),
        (0, 300, "0 of 300 episodes"),
        (300, 300, "300 of 300 episodes"),
    ],
)
def test_counts_of_a_total(count: int, total: int, said: str) -> None:
    assert counted(count, total, "episodes") == said
    assert counted(count, total) == said.replace(" episodes", "")


@given(st.floats(0.0, 1.0), st.integers(1, 4))
def test_only_0_and_1_are_written_as_0_and_1(value: float, places: int) -> None:
    assert (float(share(value, places)) == 1.0) == (value == 1.0)
    assert (float(share(value, places)) == 0.0) == (value == 0.0)
    assert abs(float(share(value, places)) - value) <= 10.0**-places


def test_minus_zero_is_written_as_zero() -> None:
    assert [number(value, 2) for value in (-0.0, -0.004, -0.006, 12.345)] == ["0.00", "0.00", "-0.01", "12.35"]


@pytest.mark.parametrize(("most", "said"), [(4, "a, b, c"), (3, "a, b, c"), (2, "a, b and 1 more")])
def test_lists(most: int, said: str) -> None:
    assert listed("abc", most) == said
    assert listed([], most) == ""


def test_columns() -> None:
    assert column("  spec  ", "reach s1 and then the exit", width=30) == "  spec  reach s1 and then the\n        exit"
    assert column("  file  ", "a/" + 40 * "b" + "-c", width=30) == "  file  a/" + 40 * "b" + "-c"
    assert column("  map   ", "") == "  map   "
