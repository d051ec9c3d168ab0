"""The statistics of reported figures, against values computed by hand and published in tables."""

from __future__ import annotations

from math import sqrt

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tltl_runtime.evaluation.statistics import Z_95, spread_of, wilson


def test_the_quantile_is_exact() -> None:
    assert pytest.approx(1.959963984540054, abs=1e-12) == Z_95


@pytest.mark.parametrize(
    ("successes", "count", "low", "high"),
    [
        # R. G. Newcombe, Statistics in Medicine 17 (1998), 857-872, table I, method 3.
        (81, 263, 0.2553, 0.3662),
        (15, 148, 0.0624, 0.1605),
        (0, 20, 0.0, 0.1611),
        (1, 29, 0.0061, 0.1718),
    ],
)
def test_intervals_equal_published_values(successes: int, count: int, low: float, high: float) -> None:
    assert wilson(successes, count) == pytest.approx((low, high), abs=5e-5)


def test_intervals_equal_values_computed_by_hand() -> None:
    # For a share of 1/2 the bounds are 1/2 ± z / (2 sqrt(n + z²)).
    assert wilson(2, 4) == pytest.approx((0.150039, 0.849961), abs=5e-7)
    assert wilson(100, 100)[1] == 1.0
    assert wilson(0, 100)[0] == 0.0


@given(st.integers(1, 400).flatmap(lambda count: st.tuples(st.integers(0, count), st.just(count))))
def test_the_bounds_are_z_deviations_from_the_share(sample: tuple[int, int]) -> None:
    """The definition of the score interval: at a bound p, |share - p| = z sqrt(p (1 - p) / n)."""
    successes, count = sample
    low, high = wilson(successes, count)
    assert 0.0 <= low <= successes / count <= high <= 1.0
    for bound in (low, high):
        off = Z_95 * sqrt(bound * (1.0 - bound) / count)
        assert abs(successes / count - bound) == pytest.approx(off, abs=1e-7)
    mirrored = wilson(count - successes, count)
    assert mirrored == pytest.approx((1.0 - high, 1.0 - low))


@pytest.mark.parametrize(("successes", "count"), [(0, 0), (-1, 5), (6, 5)])
def test_invalid_counts_are_rejected(successes: int, count: int) -> None:
    with pytest.raises(ValueError, match="is not a share"):
        wilson(successes, count)


def test_the_deviation_is_the_sample_deviation() -> None:
    spread = spread_of([2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0])
    assert (spread.mean, spread.std) == pytest.approx((5.0, sqrt(32 / 7)))
    assert spread_of([0.3]).std == 0.0
    with pytest.raises(ValueError, match="no values"):
        spread_of([])
