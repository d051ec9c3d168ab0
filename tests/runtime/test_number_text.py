"""Numbers and lines as commands print them."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tltl_runtime.support.number_text import (
    column,
    count_text,
    number,
    percent,
    quantity_text,
    share,
    short_list,
    significant,
)


@pytest.mark.parametrize(
    ("value", "text"), [(0.0, "0.00"), (0.001, "0.01"), (0.994, "0.99"), (0.996, "0.99"), (1.0, "1.00"), (0.5, "0.50")]
)
def test_a_share_is_rounded_but_never_to_0_or_1(value: float, text: str) -> None:
    assert share(value) == text
    assert percent(value) == f"{round(100 * float(text))}%"


@pytest.mark.parametrize(
    ("count", "total", "text"),
    [
        (1, 25, "1 of 25 episodes"),
        (1, 26, "1 of 26 episodes (4%)"),
        (299, 300, "299 of 300 episodes (99%)"),
        (0, 300, "0 of 300 episodes"),
        (300, 300, "300 of 300 episodes"),
    ],
)
def test_a_count_out_of_a_large_total_has_a_percentage(count: int, total: int, text: str) -> None:
    assert count_text(count, total, "episodes") == text
    assert count_text(count, total) == text.replace(" episodes", "")


@given(st.floats(0.0, 1.0), st.integers(1, 4))
def test_only_0_and_1_are_shown_as_0_and_1(value: float, places: int) -> None:
    assert (float(share(value, places)) == 1.0) == (value == 1.0)
    assert (float(share(value, places)) == 0.0) == (value == 0.0)
    assert abs(float(share(value, places)) - value) <= 10.0**-places


def test_minus_zero_is_shown_as_zero() -> None:
    assert [number(value, 2) for value in (-0.0, -0.004, -0.006, 12.345)] == ["0.00", "0.00", "-0.01", "12.35"]


@pytest.mark.parametrize(
    ("value", "gap", "text"),
    [
        (14.06, 2.06, "14.1 m"),
        (1234.4, 2.06, "1234 m"),
        (0.625, 1.0, "0.62 m"),
        (12.0004, 0.0004, "12.0004 m"),
        (0.0, 0.0, "0.00 m"),
        (7.0, 1e-15, "7.00 m"),
    ],
)
def test_a_quantity_has_the_decimals_that_show_its_difference_if_any_do(value: float, gap: float, text: str) -> None:
    assert quantity_text(value, "m", gap) == text


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0.00"),
        (-0.0, "0.00"),
        (-1e-9, "0.00"),
        (1.0, "1.00"),
        (0.7149, "0.715"),
        (-0.4164, "-0.416"),
        (0.01234, "0.0123"),
        (5.7, "5.70"),
        (9.996, "10.0"),
        (99.96, "100"),
        (122.4, "122"),
        (12345.0, "12,300"),
    ],
)
def test_a_number_for_people_has_three_significant_digits(value: float, text: str) -> None:
    assert significant(value) == text


@pytest.mark.parametrize(("most", "text"), [(4, "a, b, c"), (3, "a, b, c"), (2, "a, b and 1 more")])
def test_a_short_list_counts_the_names_that_it_leaves_out(most: int, text: str) -> None:
    assert short_list("abc", most) == text
    assert short_list([], most) == ""


def test_a_column_is_wrapped_at_words_and_keeps_long_words_whole() -> None:
    assert column("  spec  ", "reach s1 and then the exit", width=30) == "  spec  reach s1 and then the\n        exit"
    assert column("  file  ", "a/" + 40 * "b" + "-c", width=30) == "  file  a/" + 40 * "b" + "-c"
    assert column("  map   ", "") == "  map   "
