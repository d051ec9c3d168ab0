"""Packed values unpack to the same values."""

from __future__ import annotations

from itertools import accumulate, pairwise

from hypothesis import given
from hypothesis import strategies as st

from tltl_runtime.game.packing import runs, steps, x_steps, y_steps
from tltl_runtime.stealth.level import Box


def unstepped(letters: str) -> list[int]:
    """Decode steps as the script of the page does."""
    values, number, weight = [], 0, 1
    for letter in letters:
        digit = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/".index(letter)
        number, weight = number + digit % 32 * weight, weight * 32
        if digit < 32:
            values.append(number // 2 * (-1 if number % 2 else 1))
            number, weight = 0, 1
    return list(accumulate(values))


def test_numbers_are_encoded_as_in_source_maps() -> None:
    assert [steps([value], 1) for value in (0, 1, -1, 15, 16, -16, 511, 1000)] == [
        "A",
        "C",
        "D",
        "e",
        "gB",
        "hB",
        "+f",
        "w+B",
    ]


@given(st.lists(st.floats(-100, 100)))
def test_steps_decode_to_the_rounded_values(values: list[float]) -> None:
    assert unstepped(steps(values, 100)) == [round(value * 100) for value in values]


@given(st.lists(st.sampled_from("ab")))
def test_runs_expand_to_the_values(values: list[str]) -> None:
    packed = runs(values)
    assert [value for value, count in packed for _ in range(int(count))] == values
    assert all(one[0] != other[0] for one, other in pairwise(packed))


def test_places_are_in_centimetres_from_the_north_west_corner() -> None:
    bounds = Box((-10.0, 0.0, 0.0), (10.0, 8.0, 3.0))
    assert unstepped(x_steps(bounds, [-10.0, -9.5, 10.0])) == [0, 50, 2000]
    assert unstepped(y_steps(bounds, [8.0, 0.0])) == [0, 800]
