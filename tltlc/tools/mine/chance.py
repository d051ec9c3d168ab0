"""Probabilities that traces meet a bound by chance.

Every trace meets some bound: among the delays in it, one is the longest. So a bound is proposed only if
it is unlikely that the traces meet it by chance. The chance model is memoryless: what is awaited comes
at each sample with the same probability, whatever came before. So lengths of time have a geometric
distribution.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import comb, exp
from typing import Final

LEVEL: Final = 0.05
"""The greatest probability that all bounds of one template together are met by chance."""


def all_at_most(lengths: Sequence[int], most: int, least: int) -> float:
    """Return the probability that no random length is above ``most``.

    There are as many random lengths as ``lengths``, with the same mean, and each is ``least`` or more.
    """
    stay = _stay([length - least for length in lengths])
    return (1.0 - stay ** (most - least + 1)) ** len(lengths)


def all_at_least(lengths: Sequence[int], fewest: int, least: int) -> float:
    """Return the probability that no random length is below ``fewest``; the lengths are as in :func:`all_at_most`."""
    return _stay([length - least for length in lengths]) ** ((fewest - least) * len(lengths))


def no_more(gaps: Sequence[int], quiet: Sequence[int]) -> float:
    """Return the probability that no event comes during the times in ``quiet``.

    ``gaps`` are the times before the events that came. From each time in ``quiet``, a mean gap is
    subtracted, so that events at regular intervals are no surprise.
    """
    mean = sum(gaps) / len(gaps)
    return exp(-sum(max(0.0, time - mean) for time in quiet) / mean)


def separated(accepted: int, traces: int, rejected: int, counterexamples: int) -> float:
    """Return the probability that a random ranking separates traces from counterexamples so well.

    A bound rejects those above it in the ranking. Of these, at most ``traces - accepted`` are traces, and
    the others, at least ``rejected``, are counterexamples.
    """
    wrong = traces - accepted
    above = wrong + rejected
    ways = sum(comb(traces, number) * comb(counterexamples, above - number) for number in range(wrong + 1))
    return ways / comb(traces + counterexamples, above)


def _stay(lengths: Sequence[int]) -> float:
    """Return the probability of going on, in a geometric distribution from 0 with the mean of the lengths."""
    mean = sum(lengths) / len(lengths)
    return mean / (1.0 + mean)
