"""The verdict of a case: by statistics, looked at after every episode, until it is certain.

The rule, for a case whose share of the suite's ``error`` is e (the error divided by the number of cases):

1. Nothing is decided before 25 episodes.
2. ``fail`` where the pass rate is certainly below ``thresholds.fail_rate``.
3. ``pass`` where it is certainly at least ``thresholds.pass_rate``, and neither progress nor reward has changed.
4. ``review`` where it is certainly between the two, or above ``fail_rate`` and progress or reward has changed.
5. ``review``, too, where all of the case's episodes are played and nothing is certain.

The interval of the pass rate has the error e/2 over all looks at once
(:func:`~tltl_runtime.regression.confidence.rate_interval`).  Progress and reward have changed where the means over
equal seeds differ by their threshold at least, and by chance only with probability e/4; they are looked at 25, 50, 100,
... episodes, each look with an equal part of that (Bonferroni).
"""

from __future__ import annotations

from collections.abc import Sequence
from statistics import fmean
from typing import Final, Literal

from tltl_runtime.regression.account import Account
from tltl_runtime.regression.confidence import change_p_value, rate_interval
from tltl_runtime.regression.suite import LEAST_EPISODES, Thresholds
from tltlc.record import record

Verdict = Literal["pass", "review", "fail"]

_FIGURES: Final = ("progress", "reward")


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


def looks(episodes: int) -> tuple[int, ...]:
    """The numbers of episodes after which progress and reward are compared: 25, 50, 100 and so on, and the last."""
    found, due = [], LEAST_EPISODES
    while due < episodes:
        found.append(due)
        due *= 2
    return (*found, episodes)


def judge(
    now: Sequence[Account], before: Sequence[Account], episodes: int, thresholds: Thresholds, error: float
) -> Judgement | None:
    """The verdict on the episodes ``now``, of ``episodes`` at the most; None where more have to be played.

    ``before`` are the baseline's, of the same seeds in the same order, ``error`` is the case's share.
    """
    count, passed = len(now), sum(each.success for each in now)
    low, high = rate_interval(passed, count - passed, error / 2)
    if count < LEAST_EPISODES:
        return None
    over = count >= episodes
    if high < thresholds.fail_rate:
        return Judgement("fail", True, (low, high), _changes(now, before, thresholds, error, episodes))
    if count not in looks(episodes) and not over:
        return None
    changes = _changes(now, before, thresholds, error, episodes)
    verdict: Verdict = "pass" if low >= thresholds.pass_rate and not changes else "review"
    between = low >= thresholds.fail_rate and high < thresholds.pass_rate
    certain = low >= thresholds.pass_rate or between or (bool(changes) and low >= thresholds.fail_rate)
    return Judgement(verdict, certain, (low, high), changes) if certain or over else None


def _changes(
    now: Sequence[Account], before: Sequence[Account], thresholds: Thresholds, error: float, episodes: int
) -> tuple[Change, ...]:
    """The figures that have changed; of a baseline of fewer episodes only these are compared."""
    count = min(len(now), len(before))
    found = []
    for figure in _FIGURES:
        old, new = ([float(getattr(each, figure)) for each in played[:count]] for played in (before, now))
        p_value = change_p_value(old, new)
        is_relevant = abs(fmean(new) - fmean(old)) >= getattr(thresholds, figure)
        if is_relevant and p_value <= error / (2 * len(_FIGURES) * len(looks(episodes))):
            found.append(Change(figure, fmean(old), fmean(new), p_value))
    return tuple(found)
