"""The statistics of a verdict: anytime-valid tests of a pass rate and of means against a baseline.

Both tests may be evaluated after each episode. ``error`` is the allowed probability of refuting a
hypothesis that is true. A test begins with a stake of 1 and bets it, episode by episode, against
the hypothesis that it tries to refute. The odds are fair if the hypothesis holds: the stake is never
negative, and its mean does not grow. So the stake then ever exceeds 1 / ``error`` with a probability
of at most ``error``. If the stake exceeds this value, the hypothesis is refuted (J. Ville 1939; H.
Robbins, Ann. Math. Stat. 41 (1970), 1397-1409; G. Shafer, J. R. Stat. Soc. A 184 (2021), 407-431).
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from math import asin, log, pi, sqrt
from typing import Final

import numpy as np
from numpy.typing import NDArray

_POINTS: Final = 32
"""The number of alternative rates that a test bets on. They lie between the rate to be refuted and 1."""

_PLACES: Final = (np.arange(_POINTS) + 0.5) / _POINTS
"""The positions of the alternative rates on the scale arcsin(sqrt(rate)), where they are equally spaced.

Position 0 is the rate to be refuted, and position 1 is the rate 1.
"""

_SHARES: Final = (0.05, 0.2, 0.5, 0.9)
"""For each bet on a mean, the greatest share of its stake that it can lose at one value.

Large shares detect large changes sooner, small shares detect small changes. The values were chosen
by simulation, for figures with a threshold of 0.05.
"""

_TINY: Final = 1e-6
"""The least divisor of a bet.

It avoids division by 0 where a bound of the mean is also a bound of the values.
"""


def rate_interval(successes: int, failures: int, error: float) -> tuple[float, float]:
    """Return a confidence interval for a rate of success, (low, high). It may be computed after every episode.

    The episodes must be independent. With probability 1 - ``error`` at least, the rate lies in all
    intervals that are computed during a sequence of episodes, whatever its length. Each end of the
    interval has half of the error. The interval contains the rates that no test refutes. The test
    that a rate is too low spreads its bet evenly over higher rates, which are equally spaced on the
    scale arcsin(sqrt(rate)). The test that a rate is too high does so with lower rates.

    Raises:
        ValueError: a count is negative, or ``error`` is not in (0, 1).
    """
    if successes < 0 or failures < 0 or not 0.0 < error < 1.0:
        raise ValueError(f"{successes} successes, {failures} failures, error {error}: no interval")
    return _lower_end(successes, failures, error / 2), 1.0 - _lower_end(failures, successes, error / 2)


def mean_p_value(values: Sequence[float], low: float, high: float, least: float = -1.0, most: float = 1.0) -> float:
    """Return the p-value of the hypothesis that the mean of the values is in [``low``, ``high``].

    All values must be in [``least``, ``most``]. The p-value may be computed after each value, and
    is 1 without values.

    Several stakes bet that the mean is below ``low``. At each value, such a stake bets a fixed
    share of itself, and is multiplied by ``1 + share * (low - value) / (most - low)``. It does not
    grow on average if the conditional mean of each value, given the earlier ones, is at least
    ``low``. As many stakes bet in the same way that the mean is above ``high``. Under the
    hypothesis, the mean of all these stakes does not grow on average either (I. Waudby-Smith, A.
    Ramdas, J. R. Stat. Soc. B 86 (2024), 1-27). The p-value is 1 divided by the greatest value that
    this mean has had so far.

    Raises:
        ValueError: ``low`` is above ``high``, or ``least`` is not below ``most``.
    """
    if not (low <= high and least < most):
        raise ValueError(f"no mean is in [{low}, {high}] of values in [{least}, {most}]")
    array = np.asarray(values, dtype=np.float64)
    below, above = (low - array) / max(most - low, _TINY), (array - high) / max(high - least, _TINY)
    stakes = np.cumsum(np.log1p(np.stack([share * side for share in _SHARES for side in (below, above)])), axis=1)
    return float(np.exp(-max([0.0, *_log_means(stakes).tolist()])))


@lru_cache(maxsize=1 << 16)
def _lower_end(successes: int, failures: int, error: float) -> float:
    """Return the lower end of the confidence interval for a rate of success, with the given ``error``.

    The counts refute all lower rates as too low. The end is found by bisection. It is 0 if there
    are no successes.
    """
    if successes == 0:
        return 0.0
    refuted, possible = 0.0, successes / (successes + failures)
    for _ in range(50):
        middle = (refuted + possible) / 2
        if _log_stake(successes, failures, middle) > log(1 / error):
            refuted = middle
        else:
            possible = middle
    return refuted


def _log_stake(successes: int, failures: int, rate: float) -> float:
    """Return the logarithm of the stake, after these episodes, that bets against ``rate`` on higher rates.

    ``rate`` is in (0, 1). The stake is 1 before the first episode.
    """
    start = asin(sqrt(rate))
    rates = np.sin(start + (pi / 2 - start) * _PLACES) ** 2
    stakes = successes * np.log(rates / rate) + failures * np.log((1.0 - rates) / (1.0 - rate))
    return float(_log_means(stakes))


def _log_means(logarithms: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return ``log(mean(exp(logarithms)))``, with the mean over the first axis, without overflow."""
    greatest = logarithms.max(axis=0)
    # A sum and a division: `np.mean` takes much longer for a few values.
    means: NDArray[np.float64] = greatest + np.log(np.exp(logarithms - greatest).sum(axis=0) / len(logarithms))
    return means
