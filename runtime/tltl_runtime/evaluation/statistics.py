"""Statistics of episodes: means, standard deviations and confidence intervals."""

from __future__ import annotations

from collections.abc import Sequence
from math import sqrt
from statistics import NormalDist, fmean, stdev
from typing import Final

from tltlc.api import record

Z_95: Final = NormalDist().inv_cdf(0.975)
"""The quantile of the normal distribution for a two-sided 95 % interval."""


@record
class Spread:
    """A mean and a sample standard deviation (divisor n - 1; 0 for a single value)."""

    mean: float
    std: float


def spread_of(values: Sequence[float]) -> Spread:
    """Return the mean and the sample standard deviation of ``values``.

    Raises:
        ValueError: there are no values.
    """
    if not values:
        raise ValueError("there are no values")
    return Spread(fmean(values), stdev(values) if len(values) > 1 else 0.0)


def wilson(successes: int, count: int) -> tuple[float, float]:
    """Return the 95 % Wilson score interval for the share ``successes / count``.

    Both ends are in [0, 1]. Source: E. B. Wilson, J. Am. Stat. Assoc. 22 (1927), 209-212.

    Raises:
        ValueError: ``count`` is 0, or ``successes`` is not in [0, ``count``].
    """
    if not 0 <= successes <= count or count == 0:
        raise ValueError(f"{successes} of {count} is not a share")
    share, z = successes / count, Z_95
    middle = share + z * z / (2 * count)
    half = z * sqrt(share * (1 - share) / count + z * z / (4 * count * count))
    scale = 1 + z * z / count
    # Exact ends: rounding errors would put them slightly off 0 and 1.
    low = (middle - half) / scale if successes else 0.0
    high = (middle + half) / scale if successes < count else 1.0
    return low, high
