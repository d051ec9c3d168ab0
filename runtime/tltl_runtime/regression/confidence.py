"""The statistics of a verdict: a pass rate that is looked at after each episode, and changes against a baseline."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import inf, lgamma, log
from typing import Final

import numpy as np

_PRIOR: Final = 0.5
"""Of Jeffreys' mixture: Beta(1/2, 1/2)."""

_FLIPS: Final = 20_000
"""The least p-value that can be found is one in so many."""


def rate_interval(successes: int, failures: int, error: float) -> tuple[float, float]:
    """An interval for a rate that may be looked at after every episode.

    Over a whole sequence of independent episodes, however long and whenever it is stopped, the rate lies in all of its
    intervals but for a share ``error`` of the sequences: what is tested is a mixture of likelihood ratios, a
    nonnegative martingale of mean 1 (J. Ville 1939; H. Robbins, Ann. Math. Stat. 41 (1970), 1397-1409).

    Raises ValueError unless both counts are at least 0 and 0 < ``error`` < 1.
    """
    if successes < 0 or failures < 0 or not 0.0 < error < 1.0:
        raise ValueError(f"{successes} successes, {failures} failures, error {error}: no interval")
    if successes + failures == 0:
        return 0.0, 1.0
    mixture = _log_beta(successes + _PRIOR, failures + _PRIOR) - _log_beta(_PRIOR, _PRIOR)

    def excess(rate: float) -> float:
        """Above 0 where the rate is out of the interval."""
        return mixture - _log_likelihood(successes, failures, rate) - log(1 / error)

    best = successes / (successes + failures)
    low = _border(excess, 0.0, best) if successes else 0.0
    high = _border(excess, 1.0, best) if failures else 1.0
    return low, high


def change_p_value(before: Sequence[float], now: Sequence[float], seed: int = 0) -> float:
    """How likely a change of the mean is that is at least as great, where episodes of equal seeds go equally well.

    The test flips the signs of the paired differences at random (R. A. Fisher 1935); ``seed`` is that of the flips.
    Equal sequences have the p-value 1.  Raises ValueError where the sequences differ in length.
    """
    if len(before) != len(now):
        raise ValueError(f"{len(before)} values before and {len(now)} now are no pairs")
    differences = np.asarray(now, dtype=np.float64) - np.asarray(before, dtype=np.float64)
    differences = differences[differences != 0.0]
    if not differences.size:
        return 1.0
    signs = np.random.default_rng(seed).integers(0, 2, (_FLIPS, differences.size), dtype=np.int8)
    flipped = np.abs((2.0 * signs - 1.0) @ differences)
    # Rounding must not make a tie less than what it ties with.
    as_great = np.count_nonzero(flipped >= abs(differences.sum()) * (1 - 1e-12))
    return float((1 + as_great) / (1 + _FLIPS))


def _log_beta(a: float, b: float) -> float:
    return lgamma(a) + lgamma(b) - lgamma(a + b)


def _log_likelihood(successes: int, failures: int, rate: float) -> float:
    if (successes and rate <= 0.0) or (failures and rate >= 1.0):
        return -inf
    return (successes * log(rate) if successes else 0.0) + (failures * log(1.0 - rate) if failures else 0.0)


def _border(excess: Callable[[float], float], outside: float, inside: float) -> float:
    """Where the interval ends between a rate outside of it and one inside; the end is outside by a hair at the most."""
    for _ in range(60):
        middle = (outside + inside) / 2
        if excess(middle) > 0.0:
            outside = middle
        else:
            inside = middle
    return outside
