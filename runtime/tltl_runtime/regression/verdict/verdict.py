"""The verdict of a case: by statistics, looked at after every episode, until it is certain.

The rule, for a case whose share of the suite's ``error`` is e (the error divided by the number of cases):

1. Nothing is decided before 25 episodes.
2. ``fail`` where the pass rate is certainly below ``thresholds.fail_rate``.
3. ``review`` where it is certainly not, but certainly below ``thresholds.pass_rate``, or progress or reward has
   certainly changed.
4. ``pass`` where it is certainly at least ``thresholds.pass_rate``, and the means of progress and reward differ from
   the baseline's by half of their thresholds at most.
5. Where all of the case's episodes are played and nothing is certain: ``pass`` where the pass rate is certainly at
   least ``thresholds.pass_rate``, and the means differ by less than their thresholds, else ``review``.

The pass rate is certainly outside of its interval, which has the error e over all looks at once
(:func:`~tltl_runtime.regression.verdict.confidence.rate_interval`).  Means are compared over equal seeds.  A figure has
certainly changed where they differ by its threshold at least, and the p-value of its mean being that near to the
baseline's, over all looks at once, is e/4 at most (:func:`~tltl_runtime.regression.verdict.confidence.mean_p_value`):
the mean
of the policy's episodes is then further from the one that was recorded.  So e bounds the probability of a wrong verdict
that is certain, by the rate or by the figures, whatever the pass rate is.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from operator import attrgetter
from statistics import fmean
from typing import Final, Literal

from tltl_runtime.evaluation.outcome import Outcome
from tltl_runtime.regression.suite.suite import LEAST_EPISODES, Thresholds
from tltl_runtime.regression.verdict.confidence import mean_p_value, rate_interval
from tltlc.core.record import record

Verdict = Literal["pass", "review", "fail"]

FIGURES: Final[Mapping[str, tuple[float, float]]] = {"progress": (0.0, 1.0), "reward": (-1.0, 1.0)}
"""What is compared with the baseline, and between which values it lies.

A reward is progress less the share of the limit that it took, the rest of which a violation costs, too (Algorithm 1).
"""

_ALIKE: Final = 0.5
"""Means are alike that differ by this share of the threshold at most."""


@record
class Change:
    """A figure's mean, and the baseline's that it is further from than its threshold; how likely that is by chance."""

    figure: str
    before: float
    now: float
    p_value: float


@record
class Judgement:
    """A verdict: ``certain`` unless it is only since all episodes are played; ``rate_interval`` of the pass rate."""

    verdict: Verdict
    certain: bool
    rate_interval: tuple[float, float]
    changes: tuple[Change, ...]


def judge(
    now: Sequence[Outcome], before: Sequence[Outcome], episodes: int, thresholds: Thresholds, error: float
) -> Judgement | None:
    """The verdict on the episodes ``now``, of ``episodes`` at the most; None where more have to be played.

    ``before`` are the baseline's, of the same seeds in the same order, ``error`` is the case's share.
    """
    if len(now) < LEAST_EPISODES:
        return None
    passed = sum(each.success for each in now)
    low, high = interval = rate_interval(passed, len(now) - passed, error)
    differences = _differences(now, before)
    apart = _beyond(differences, thresholds)
    changes = tuple(_changes(apart, now, before, thresholds, error))
    if high < thresholds.fail_rate:
        return Judgement("fail", True, interval, changes)
    if low >= thresholds.fail_rate and (high < thresholds.pass_rate or changes):
        return Judgement("review", True, interval, changes)
    is_met = low >= thresholds.pass_rate
    if is_met and all(by <= _ALIKE * getattr(thresholds, figure) for figure, by in differences.items()):
        return Judgement("pass", True, interval, changes)
    if len(now) < episodes:
        return None
    return Judgement("pass" if is_met and not apart else "review", False, interval, changes)


def beyond(now: Sequence[Outcome], before: Sequence[Outcome], thresholds: Thresholds) -> tuple[str, ...]:
    """The figures whose means differ over equal seeds by their thresholds at least, which may be by chance."""
    return _beyond(_differences(now, before), thresholds)


def _beyond(differences: Mapping[str, float], thresholds: Thresholds) -> tuple[str, ...]:
    return tuple(figure for figure, by in differences.items() if 0 < by >= getattr(thresholds, figure))


def _differences(now: Sequence[Outcome], before: Sequence[Outcome]) -> dict[str, float]:
    """By how much the means of each figure differ over the seeds that both have."""
    count = min(len(now), len(before))
    pairs = {figure: (_values(now[:count], figure), _values(before[:count], figure)) for figure in FIGURES}
    return {figure: abs(fmean(new) - fmean(old)) for figure, (new, old) in pairs.items()}


def _changes(
    figures: Sequence[str], now: Sequence[Outcome], before: Sequence[Outcome], thresholds: Thresholds, error: float
) -> Iterator[Change]:
    """Those of the figures that have certainly changed."""
    for figure in figures:
        values, old, most = _values(now, figure), fmean(_values(before, figure)), getattr(thresholds, figure)
        p_value = mean_p_value(values, old - most, old + most, *FIGURES[figure])
        if p_value <= error / (2 * len(FIGURES)):
            yield Change(figure, old, fmean(values), p_value)


def _values(outcomes: Sequence[Outcome], figure: str) -> list[float]:
    return list(map(attrgetter(figure), outcomes))
