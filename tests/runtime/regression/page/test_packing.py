"""What is packed is there again when it is unpacked."""

from __future__ import annotations

from itertools import accumulate, pairwise

from hypothesis import given
from hypothesis import strategies as st

from tltl_runtime.regression.page.packing import across, down, runs, steps
from tltl_runtime.stealth.level import Box


@given(st.lists(st.floats(-100, 100)))
def test_steps_add_up(values: list[float]) -> None:
    assert list(accumulate(steps(values, 100))) == [round(value * 100) for value in values]


@given(st.lists(st.sampled_from("ab")))
def test_runs_are_as_long_as_what_they_stand_for(values: list[str]) -> None:
    packed = runs(values)
    assert [value for value, count in packed for _ in range(int(count))] == values
    assert all(one[0] != other[0] for one, other in pairwise(packed))


def test_places_are_centimetres_from_the_north_western_corner() -> None:
    bounds = Box((-10.0, 0.0, 0.0), (10.0, 8.0, 3.0))
    assert across(bounds, [-10.0, -9.5, 10.0]) == [0, 50, 1950]
    assert down(bounds, [8.0, 0.0]) == [0, 800]
