"""The verdict of a case: by statistics, looked at after every episode, until it is certain.

The rule, for a case whose share of the suite's ``error`` is e (the error divided by the number of cases):

1. Nothing is decided before 25 episodes.
2. ``fail`` where the pass rate is certainly below ``thresholds.fail_rate``.
3. ``review`` where it is certainly not, but certainly below ``thresholds.pass_rate``, or progress or reward has
   certainly changed.
4. ``pass`` where it is certainly at least ``thresholds.pass_rate``, and the means of progress and reward differ from
   the baseline's by half of their thresholds at most.
5. Where all of the case's episodes are played and nothing is certain: ``pass`` where the pass rate is certainly at
   least ``thresholds.pass_rate``, else ``review``.

The pass rate is certainly outside of its interval, which has the error e over all looks at once
(:func:`~tltl_runtime.regression.confidence.rate_interval`).  A figure has certainly changed where its means over equal
seeds differ by its threshold at least, and the p-value of that, over all looks at once, is e/4 at most
(:func:`~tltl_runtime.regression.confidence.change_p_value`).  So e bounds the probability of a wrong verdict that is
certain, by the rate or by the figures, whatever the pass rate is.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from operator import attrgetter
from statistics import fmean
from typing import Final, Literal, Protocol

from tltl_runtime.regression.confidence import change_p_value, rate_interval
from tltl_runtime.regression.suite import LEAST_EPISODES, Thresholds
from tltlc.record import record

Verdict = Literal["pass", "review", "fail"]

FIGURES: Final = ("progress", "reward")
"""What is compared with the baseline."""

_ALIKE: Final = 0.5
"""Means are alike that differ by this share of the threshold at most."""


class Outcome(Protocol):
    """What a verdict looks at in an episode, an :class:`~tltl_runtime.regression.account.Account` as a rule."""

    @property
    def success(self) -> bool:
        """Whether the spec was met."""

    @property
    def progress(self) -> float:
        """The best, in [0, 1]."""

    @property
    def reward(self) -> float:
        """The sum over the steps."""


@record
class Change:
    """A figure's mean that differs from the baseline's over the same seeds, and how likely that is by chance."""

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
    means = tuple(_means(now, before))
    changes = tuple(_changes(means, now, before, thresholds, error))
    if high < thresholds.fail_rate:
        return Judgement("fail", True, interval, changes)
    if low >= thresholds.fail_rate and (high < thresholds.pass_rate or changes):
        return Judgement("review", True, interval, changes)
    alike = all(abs(new - old) <= _ALIKE * getattr(thresholds, figure) for figure, old, new in means)
    if low >= thresholds.pass_rate and alike:
        return Judgement("pass", True, interval, changes)
    if len(now) < episodes:
        return None
    return Judgement("pass" if low >= thresholds.pass_rate else "review", False, interval, changes)


def _means(now: Sequence[Outcome], before: Sequence[Outcome]) -> Iterator[tuple[str, float, float]]:
    """The means of each figure, before and now; of a baseline of fewer episodes only these are compared."""
    count = min(len(now), len(before))
    for figure in FIGURES:
        old, new = (fmean(_values(outcomes[:count], figure)) for outcomes in (before, now))
        yield figure, old, new


def _changes(
    means: Sequence[tuple[str, float, float]],
    now: Sequence[Outcome],
    before: Sequence[Outcome],
    thresholds: Thresholds,
    error: float,
) -> Iterator[Change]:
    count = min(len(now), len(before))
    for figure, old, new in means:
        # Most episodes end alike, so that what the test costs is spared.
        if abs(new - old) >= getattr(thresholds, figure):
            p_value = change_p_value(_values(before[:count], figure), _values(now[:count], figure))
            if p_value <= error / (2 * len(FIGURES)):
                yield Change(figure, old, new, p_value)


def _values(outcomes: Sequence[Outcome], figure: str) -> list[float]:
    return list(map(attrgetter(figure), outcomes))
