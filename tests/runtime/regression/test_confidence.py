"""The statistics of verdicts hold what they promise, however often they are looked at."""

from __future__ import annotations

from math import asin, comb, log, pi, sin, sqrt, tanh

import numpy as np
import pytest

from tltl_runtime.evaluation.statistics import wilson
from tltl_runtime.regression.confidence import change_p_value, rate_interval

SEQUENCES = 400
EPISODES = 150


def most(error: float) -> int:
    """Of the sequences, more than so many go wrong once in a million times, where each does with that probability."""
    left, count = 1.0, -1
    while left > 1e-6:
        count += 1
        left -= comb(SEQUENCES, count) * error**count * (1 - error) ** (SEQUENCES - count)
    return count


def ever_outside(rate: float, error: float, seed: int, interval: object = rate_interval) -> int:
    """In how many sequences the rate is at any time outside of its interval."""
    met = np.random.default_rng(seed).random((SEQUENCES, EPISODES)) < rate
    known: dict[tuple[int, int], bool] = {}

    def is_outside(passed: int, failed: int) -> bool:
        if (passed, failed) not in known:
            low, high = interval(passed, failed, error)  # type: ignore[operator]
            known[passed, failed] = not low <= rate <= high
        return known[passed, failed]

    counts = met.cumsum(axis=1)
    return sum(any(is_outside(int(each), row + 1 - int(each)) for row, each in enumerate(line)) for line in counts)


@pytest.mark.parametrize("rate", [0.5, 0.85, 0.97])
@pytest.mark.parametrize("error", [0.2, 0.05])
def test_the_rate_is_seldom_ever_outside(rate: float, error: float) -> None:
    assert ever_outside(rate, error, seed=3) <= most(error)


def test_an_interval_that_is_made_for_one_look_does_not_hold_for_many() -> None:
    def once(passed: int, failed: int, error: float) -> tuple[float, float]:
        assert error == 0.05
        return wilson(passed, passed + failed)

    assert ever_outside(0.85, 0.05, 3, once) > 3 * 0.05 * SEQUENCES


@pytest.mark.parametrize(("passed", "failed"), [(0, 0), (25, 0), (0, 25), (24, 1), (190, 10), (7, 93)])
def test_an_interval_is_around_what_was_seen(passed: int, failed: int) -> None:
    low, high = rate_interval(passed, failed, 0.05)
    assert 0.0 <= low <= high <= 1.0
    if passed + failed:
        assert low <= passed / (passed + failed) <= high
    assert (low == 0.0) == (passed == 0) and (high == 1.0) == (failed == 0)
    mirrored = rate_interval(failed, passed, 0.05)
    assert (1 - mirrored[1], 1 - mirrored[0]) == pytest.approx((low, high), abs=1e-9)


def test_more_episodes_and_more_error_make_it_narrower() -> None:
    widths = [high - low for low, high in (rate_interval(9 * n, n, 0.05) for n in (1, 4, 16, 64, 256))]
    assert widths == sorted(widths, reverse=True) and widths[-1] < 0.08
    wide, narrow = rate_interval(90, 10, 0.001), rate_interval(90, 10, 0.2)
    assert wide[0] < narrow[0] < 0.9 < narrow[1] < wide[1]


def test_the_lower_end_is_where_the_stake_is_what_the_page_says() -> None:
    passed, failed, error = 40, 3, 0.01
    low, _ = rate_interval(passed, failed, error)
    start = asin(sqrt(low))
    rates = [sin(start + (pi / 2 - start) * (place + 0.5) / 32) ** 2 for place in range(32)]
    stake = sum((rate / low) ** passed * ((1 - rate) / (1 - low)) ** failed for rate in rates) / 32
    assert log(stake) == pytest.approx(log(2 / error), abs=1e-6)


@pytest.mark.parametrize("counts", [(-1, 3, 0.05), (3, -1, 0.05), (3, 3, 0.0), (3, 3, 1.0)])
def test_what_has_no_interval(counts: tuple[int, int, float]) -> None:
    with pytest.raises(ValueError, match="no interval"):
        rate_interval(*counts)


def differences(seed: int, count: int) -> np.ndarray:  # type: ignore[type-arg]
    """Rewards of episodes of equal seeds: mostly a little otherwise, seldom much."""
    rng = np.random.default_rng(seed)
    return rng.normal(0.0, 0.05, count) + rng.choice([-0.9, 0.0, 0.9], count, p=[0.04, 0.92, 0.04])


def smallest(drift: float, seed: int, count: int = 100) -> float:
    """The least p-value of a sequence of episodes, looked at after each one: it is the last one."""
    before = np.random.default_rng(seed).uniform(0.5, 0.9, count)
    return change_p_value(before.tolist(), (before + differences(seed, count) + drift).tolist())


@pytest.mark.parametrize("error", [0.3, 0.1, 0.03])
def test_what_has_not_changed_is_seldom_ever_called_changed(error: float) -> None:
    found = sum(smallest(0.0, seed) <= error for seed in range(SEQUENCES))
    assert found <= most(error)


def test_what_has_changed_is_found() -> None:
    for drift in (-0.1, 0.1):
        assert sum(smallest(drift, seed) <= 0.01 for seed in range(50)) > 45


def test_a_p_value_never_rises() -> None:
    before = [0.7] * 60
    now = (0.7 + differences(2, 60) - 0.05).tolist()
    values = [change_p_value(before[:count], now[:count]) for count in range(1, 61)]
    assert values == sorted(values, reverse=True)


def test_a_p_value_is_what_the_page_says() -> None:
    before, now = [0.5, 0.7, 0.6], [0.1, 0.2, 0.7]
    bets = [(1, 0.99), (2, 0.99), (4, 0.99), (16, 0.25), (16, 0.5), (16, 0.9)]
    stakes = [1.0] * (2 * len(bets))
    greatest = 1.0
    for one, other in zip(before, now, strict=True):
        for place, (steep, share) in enumerate(bets):
            factor = share * tanh(steep * (other - one))
            stakes[2 * place] *= 1 + factor
            stakes[2 * place + 1] *= 1 - factor
        greatest = max(greatest, sum(stakes) / len(stakes))
    assert change_p_value(before, now) == pytest.approx(1 / greatest)


def test_equal_sequences_have_not_changed() -> None:
    assert change_p_value([0.1, 0.9], [0.1, 0.9]) == 1.0
    assert change_p_value([], []) == 1.0


def test_sequences_of_other_lengths_are_no_pairs() -> None:
    with pytest.raises(ValueError, match="no pairs"):
        change_p_value([0.1], [])
