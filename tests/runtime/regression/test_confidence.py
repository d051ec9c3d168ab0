"""The statistics of verdicts keep their error bounds, however often they are evaluated."""

from __future__ import annotations

from math import asin, comb, log, pi, sin, sqrt

import numpy as np
import pytest

from tltl_runtime.evaluation.statistics import wilson
from tltl_runtime.regression.verdict.confidence import mean_p_value, rate_interval

SEQUENCES, EPISODES = 400, 150
SIZES = [(200, 60), pytest.param((SEQUENCES, EPISODES), marks=pytest.mark.slow)]
"""Numbers of sequences and of their episodes: the small ones already refute an interval for one evaluation."""


def most(error: float, sequences: int = SEQUENCES) -> int:
    """The number of wrong sequences that is exceeded with probability 1e-6.

    Each of the sequences is wrong with probability ``error``.
    """
    left, count = 1.0, -1
    while left > 1e-6:
        count += 1
        left -= comb(sequences, count) * error**count * (1 - error) ** (sequences - count)
    return count


def ever_outside(rate: float, error: float, seed: int, size: tuple[int, int], interval: object = rate_interval) -> int:
    """The number of sequences in which the rate is ever outside its interval."""
    met = np.random.default_rng(seed).random(size) < rate
    outside: dict[tuple[int, int], bool] = {}

    def is_outside(passed: int, failed: int) -> bool:
        if (passed, failed) not in outside:
            low, high = interval(passed, failed, error)  # type: ignore[operator]
            outside[passed, failed] = not low <= rate <= high
        return outside[passed, failed]

    counts = met.cumsum(axis=1)
    return sum(
        any(is_outside(int(passed), row + 1 - int(passed)) for row, passed in enumerate(line)) for line in counts
    )


@pytest.mark.parametrize("rate", [0.5, 0.85, 0.97])
@pytest.mark.parametrize("error", [0.2, 0.05])
@pytest.mark.parametrize("size", SIZES)
def test_the_rate_is_rarely_ever_outside_its_interval(rate: float, error: float, size: tuple[int, int]) -> None:
    assert ever_outside(rate, error, 3, size) <= most(error, size[0])


@pytest.mark.parametrize("size", [(200, 60), (SEQUENCES, EPISODES)])
def test_an_interval_for_one_evaluation_fails_when_evaluated_often(size: tuple[int, int]) -> None:
    def once(passed: int, failed: int, error: float) -> tuple[float, float]:
        assert error == 0.05
        return wilson(passed, passed + failed)

    outside = ever_outside(0.85, 0.05, 3, size, once)
    assert outside > 3 * 0.05 * size[0] and outside > most(0.05, size[0])


@pytest.mark.parametrize(("passed", "failed"), [(0, 0), (25, 0), (0, 25), (24, 1), (190, 10), (7, 93)])
def test_an_interval_contains_the_observed_rate(passed: int, failed: int) -> None:
    low, high = rate_interval(passed, failed, 0.05)
    assert 0.0 <= low <= high <= 1.0
    if passed + failed:
        assert low <= passed / (passed + failed) <= high
    assert (low == 0.0) == (passed == 0) and (high == 1.0) == (failed == 0)
    mirrored = rate_interval(failed, passed, 0.05)
    assert (1 - mirrored[1], 1 - mirrored[0]) == pytest.approx((low, high), abs=1e-9)


def test_more_episodes_and_a_larger_error_narrow_the_interval() -> None:
    widths = [high - low for low, high in (rate_interval(9 * n, n, 0.05) for n in (1, 4, 16, 64, 256))]
    assert widths == sorted(widths, reverse=True) and widths[-1] < 0.08
    wide, narrow = rate_interval(90, 10, 0.001), rate_interval(90, 10, 0.2)
    assert wide[0] < narrow[0] < 0.9 < narrow[1] < wide[1]


def test_the_lower_end_follows_the_formula_of_the_page() -> None:
    passed, failed, error = 40, 3, 0.01
    low, _ = rate_interval(passed, failed, error)
    start = asin(sqrt(low))
    rates = [sin(start + (pi / 2 - start) * (place + 0.5) / 32) ** 2 for place in range(32)]
    stake = sum((rate / low) ** passed * ((1 - rate) / (1 - low)) ** failed for rate in rates) / 32
    assert log(stake) == pytest.approx(log(2 / error), abs=1e-6)


@pytest.mark.parametrize("counts", [(-1, 3, 0.05), (3, -1, 0.05), (3, 3, 0.0), (3, 3, 1.0)])
def test_invalid_counts_have_no_interval(counts: tuple[int, int, float]) -> None:
    with pytest.raises(ValueError, match="no interval"):
        rate_interval(*counts)


def rewards(seed: int, mean: float, count: int = 120) -> list[float]:
    """Noisy rewards of episodes of which 95 % succeed; the expected reward is ``mean``."""
    rng = np.random.default_rng(seed)
    met = rng.random(count) < 0.95
    drawn = np.where(met, rng.uniform(-0.15, 0.15, count) + 0.05, rng.uniform(-0.15, 0.15, count) - 0.95)
    values: list[float] = (drawn + mean).tolist()
    return values


@pytest.mark.parametrize("error", [0.3, 0.1, 0.03])
@pytest.mark.parametrize("mean", [0.65, 0.75])
def test_an_unchanged_mean_is_rarely_called_changed(error: float, mean: float) -> None:
    # Both means are ends of the range that counts as unchanged, where a change is hardest to rule out.
    false_alarms = sum(mean_p_value(rewards(seed, mean), 0.65, 0.75) <= error for seed in range(SEQUENCES))
    assert false_alarms <= most(error)


def test_a_changed_mean_is_detected() -> None:
    for mean in (0.5, 0.9):
        low, high = (0.65, 0.75) if mean < 0.7 else (0.5, 0.6)
        assert sum(mean_p_value(rewards(seed, mean - 0.1), low, high) <= 0.01 for seed in range(50)) > 45


def test_a_p_value_never_rises() -> None:
    episode_rewards = rewards(2, 0.6)
    values = [mean_p_value(episode_rewards[:count], 0.65, 0.75) for count in range(1, 121)]
    assert values == sorted(values, reverse=True) and values[-1] < 1.0


def test_a_p_value_follows_the_formula_of_the_page() -> None:
    values, low, high, least, top = [0.1, 0.2, 0.7], 0.4, 0.5, -1.0, 1.0
    shares = [0.05, 0.2, 0.5, 0.9]
    stakes, greatest = [1.0] * (2 * len(shares)), 1.0
    for value in values:
        for place, share in enumerate(shares):
            stakes[2 * place] *= 1 + share * (low - value) / (top - low)
            stakes[2 * place + 1] *= 1 + share * (value - high) / (high - least)
        greatest = max(greatest, sum(stakes) / len(stakes))
    assert greatest > 1.0
    assert mean_p_value(values, low, high) == pytest.approx(1 / greatest)


def test_no_bet_loses_its_whole_stake() -> None:
    """Alternate the worst value for a bet with the value that refutes the interval."""
    for worst, then in ((1.0, -1.0), (-1.0, 1.0)):
        assert mean_p_value([worst, then] * 200, -0.1 + worst / 2, 0.1 + worst / 2) < 1e-6


@pytest.mark.parametrize(("value", "low", "high"), [(0.9, 1.0, 1.0), (-0.9, -1.0, -1.0)])
def test_an_extreme_mean_is_refuted_by_the_first_different_value(value: float, low: float, high: float) -> None:
    assert mean_p_value([low], low, high) == 1.0
    assert mean_p_value([low, value], low, high) < 1e-4


def test_values_inside_the_interval_refute_nothing() -> None:
    assert mean_p_value([0.1, 0.2, 0.15] * 100, 0.1, 0.2) == 1.0
    assert mean_p_value([], 0.1, 0.2) == 1.0


@pytest.mark.parametrize("ends", [(0.2, 0.1, -1.0, 1.0), (0.1, 0.2, 1.0, 1.0), (float("nan"), 0.2, -1.0, 1.0)])
def test_invalid_intervals_of_means_are_rejected(ends: tuple[float, float, float, float]) -> None:
    with pytest.raises(ValueError, match="no mean"):
        mean_p_value([0.1], *ends)
