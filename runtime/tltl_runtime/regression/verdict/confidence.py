"""The statistics of a verdict: a pass rate, and figures beside a baseline's, looked at after each episode.

Both tests are bets at fair odds on what is to be refuted: a stake that never falls below 0 and is 1 on average, however
long one plays, exceeds 1/e but with probability e, whenever one stops (J. Ville 1939; H. Robbins, Ann. Math. Stat. 41
(1970), 1397-1409; G. Shafer, J. R. Stat. Soc. A 184 (2021), 407-431).
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from math import asin, log, pi, sqrt
from typing import Final

import numpy as np
from numpy.typing import NDArray

_POINTS: Final = 32
"""So many rates are bet on, between the one that is to be refuted and 1."""

_PLACES: Final = (np.arange(_POINTS) + 0.5) / _POINTS
"""Where they lie between the two, from 0 to 1 on the scale of arcsine and root."""

_SHARES: Final = (0.05, 0.2, 0.5, 0.9)
"""What bets on a mean risk, of what no value can make them lose: great shares win sooner, small ones by less.

They were chosen by simulation, for figures whose changes count from 0.05 on.
"""

_TINY: Final = 1e-6
"""Where an end of a mean's interval is that near to what no value exceeds, so near are all values or it is refuted."""


def rate_interval(successes: int, failures: int, error: float) -> tuple[float, float]:
    """An interval for a rate that may be looked at after every episode.

    Over a whole sequence of independent episodes, however long and whenever it is stopped, the rate lies in all of its
    intervals but for a share ``error`` of the sequences, and below and above them but for half of that each.  A rate
    is bet against on equal shares of those above it, equally far apart on the scale of arcsine and root, and likewise
    below.

    Raises ValueError unless both counts are at least 0 and 0 < ``error`` < 1.
    """
    if successes < 0 or failures < 0 or not 0.0 < error < 1.0:
        raise ValueError(f"{successes} successes, {failures} failures, error {error}: no interval")
    return _lower_end(successes, failures, error / 2), 1.0 - _lower_end(failures, successes, error / 2)


def mean_p_value(values: Sequence[float], low: float, high: float, least: float = -1.0, most: float = 1.0) -> float:
    """How likely values in [``least``, ``most``] are as one-sided at any time, if their mean is in [``low``, ``high``].

    Where the mean of each, given those before, is at least ``low``, a stake multiplied by
    1 + share * (low - value) / (most - low) does not grow on average, and likewise above ``high``; so neither does the
    mean of such stakes, of several shares on both sides (I. Waudby-Smith, A. Ramdas, J. R. Stat. Soc. B 86 (2024),
    1-27).  The p-value is 1 over its greatest value so far, so it may be looked at after each value.

    Raises ValueError where ``low`` is above ``high``, or ``least`` not below ``most``.
    """
    if not (low <= high and least < most):
        raise ValueError(f"no mean is in [{low}, {high}] of values in [{least}, {most}]")
    found = np.asarray(values, dtype=np.float64)
    below, above = (low - found) / max(most - low, _TINY), (found - high) / max(high - least, _TINY)
    stakes = np.cumsum(np.log1p(np.stack([share * side for share in _SHARES for side in (below, above)])), axis=1)
    return float(np.exp(-max([0.0, *_log_means(stakes).tolist()])))


@lru_cache(maxsize=1 << 16)
def _lower_end(successes: int, failures: int, error: float) -> float:
    """The greatest rate of which, as of all lower ones, it is certain that it is too low."""
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
    """The logarithm of what has become of a stake of 1 against ``rate``, in (0, 1), on those above it."""
    start = asin(sqrt(rate))
    rates = np.sin(start + (pi / 2 - start) * _PLACES) ** 2
    stakes = successes * np.log(rates / rate) + failures * np.log((1.0 - rates) / (1.0 - rate))
    return float(_log_means(stakes))


def _log_means(logarithms: NDArray[np.float64]) -> NDArray[np.float64]:
    """The logarithm of the mean over the first axis of what logarithms are given of."""
    greatest = logarithms.max(axis=0)
    # As `np.mean`, which takes much longer for a few values.
    means: NDArray[np.float64] = greatest + np.log(np.exp(logarithms - greatest).sum(axis=0) / len(logarithms))
    return means
