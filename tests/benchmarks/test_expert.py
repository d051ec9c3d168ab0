"""Figures of the expert: the confidence interval of a rate, and the report of a few episodes."""

from __future__ import annotations

import pytest

from benchmarks.expert import wilson


@pytest.mark.parametrize(
    ("successes", "episodes", "low", "high"),
    # The last two rows are examples from R. G. Newcombe, Statistics in Medicine 17 (1998), method 3.
    [(0, 10, 0.0, 0.2775), (10, 10, 0.7225, 1.0), (81, 263, 0.2553, 0.3662), (1, 29, 0.0061, 0.1718)],
)
def test_the_interval_of_a_rate_matches_published_examples(
    successes: int, episodes: int, low: float, high: float
) -> None:
    assert wilson(successes, episodes) == pytest.approx((low, high), abs=5e-5)


def test_episodes_are_grouped_by_the_barriers_that_opened() -> None:
    pytest.importorskip("pybullet")
    from benchmarks.expert import play_episodes

    record = play_episodes("cover_and_hide", "v0", "careless", 2)
    assert list(record["barriers"]) == [""]
    assert record["barriers"][""]["episodes"] == 2
    assert record["barriers"][""]["chased"] == 1.0
