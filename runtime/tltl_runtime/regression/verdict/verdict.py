"""Judge a case of a regression suite by statistics that are evaluated after every episode.

In a case, a policy plays a level, and its episodes are compared with those of a baseline. The pass
rate is the share of successful episodes. In the text below, e is the allowed probability of a wrong
verdict on one case: the ``error`` of the suite divided by the number of its cases. The first of
these rules that applies decides:

1. There is no verdict before 25 episodes.
2. ``fail`` if the pass rate is certainly below ``thresholds.fail_rate``.
3. ``review`` if the pass rate is certainly at least ``thresholds.fail_rate``, and one of these
   holds: it is certainly below ``thresholds.pass_rate``; progress has certainly changed; reward has
   certainly changed.
4. ``pass`` if the pass rate is certainly at least ``thresholds.pass_rate``, and the means of
   progress and reward differ from the baseline by half of their thresholds at most.
5. No verdict yet if episodes are left to play.
6. ``pass`` if the pass rate is certainly at least ``thresholds.pass_rate``, and the means of
   progress and reward differ from the baseline by less than their thresholds.
7. ``review`` otherwise.

A statement on the pass rate is certain if it follows from the confidence interval of the rate,
whose error over all evaluations is e
(:func:`~tltl_runtime.regression.verdict.confidence.rate_interval`). A figure (progress or reward)
has certainly changed if both of these hold:

- Over the seeds that were played both now and in the baseline, its two means differ by at least
  its threshold.
- A test refutes the hypothesis that the policy's true mean differs from the mean of all episodes of
  the baseline by at most the threshold. The p-value of the test is at most e/4, over all
  evaluations (:func:`~tltl_runtime.regression.verdict.confidence.mean_p_value`).

Each end of the interval is wrong with a probability of at most e/2, and the test of each of the two
figures with at most e/4. Whatever the true pass rate is, only one end of the interval can make the
verdict wrong. So the probability that a certain verdict is wrong is at most e/2 + 2 · e/4 = e.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from operator import attrgetter
from statistics import fmean
from typing import Final, Literal

from tltl_runtime.regression.suite.suite import LEAST_EPISODES
from tltl_runtime.regression.suite.thresholds import Thresholds
from tltl_runtime.regression.verdict.confidence import mean_p_value, rate_interval
from tltl_runtime.spec.episode_summary import EpisodeSummary
from tltlc.api import record

CaseVerdict = Literal["pass", "review", "fail"]

FIGURES: Final[Mapping[str, tuple[float, float]]] = {"progress": (0.0, 1.0), "reward": (-1.0, 1.0)}
"""The figures that are compared with the baseline, each with its range.

The reward of a successful episode is its progress minus the share of the step limit that it used.
The reward of a failed episode is its progress minus 1.
"""

_EQUAL_SHARE: Final = 0.5
"""Two means count as equal if they differ by at most this share of the threshold."""


@record
class FigureChange:
    """A certain change of progress or reward: its mean ``before``, in the baseline, and ``now``.

    ``figure`` is ``progress`` or ``reward``. ``p_value`` belongs to the hypothesis that the policy's
    true mean differs from the baseline's mean by at most the threshold.
    """

    figure: str
    before: float
    now: float
    p_value: float


@record
class Judgement:
    """A verdict, and the statistics that justify it.

    ``certain`` is False if the verdict was only given because all episodes were played.
    ``rate_interval`` is the confidence interval of the pass rate. ``changes`` are the certain
    changes of progress and reward.
    """

    verdict: CaseVerdict
    certain: bool
    rate_interval: tuple[float, float]
    changes: tuple[FigureChange, ...]


def judge(
    now: Sequence[EpisodeSummary],
    before: Sequence[EpisodeSummary],
    episodes: int,
    thresholds: Thresholds,
    error: float,
    *,
    paired: bool = True,
) -> Judgement | None:
    """Return the verdict on the episodes ``now``, or None if more episodes have to be played.

    ``before`` are the episodes of the baseline. If the two are ``paired``, they have the same seeds
    in the same order, and their means are compared over the seeds that both have; otherwise, over
    all episodes. ``episodes`` is the greatest number of episodes that may be played. ``error`` is
    the allowed probability that a certain verdict is wrong.
    """
    if len(now) < LEAST_EPISODES:
        return None
    passed = sum(episode.success for episode in now)
    low, high = interval = rate_interval(passed, len(now) - passed, error)
    differences = _differences(now, before, paired=paired)
    differing = _differing_figures(differences, thresholds)
    changes = tuple(_changes(differing, now, before, thresholds, error))
    if high < thresholds.fail_rate:
        return Judgement("fail", True, interval, changes)
    if low >= thresholds.fail_rate and (high < thresholds.pass_rate or changes):
        return Judgement("review", True, interval, changes)
    is_met = low >= thresholds.pass_rate
    if is_met and all(
        difference <= _EQUAL_SHARE * getattr(thresholds, figure) for figure, difference in differences.items()
    ):
        return Judgement("pass", True, interval, changes)
    if len(now) < episodes:
        return None
    return Judgement("pass" if is_met and not differing else "review", False, interval, changes)


def differing_figures(
    now: Sequence[EpisodeSummary], before: Sequence[EpisodeSummary], thresholds: Thresholds, *, paired: bool = True
) -> tuple[str, ...]:
    """Return which of ``progress`` and ``reward`` differ from the baseline by at least their thresholds.

    ``now`` and ``before`` are the episodes now and in the baseline. If they are ``paired``, both
    begin with the same seeds in the same order, and the means are compared over these; otherwise
    over all episodes. The differences may be due to chance.
    """
    return _differing_figures(_differences(now, before, paired=paired), thresholds)


def _differing_figures(differences: Mapping[str, float], thresholds: Thresholds) -> tuple[str, ...]:
    return tuple(figure for figure, difference in differences.items() if 0 < difference >= getattr(thresholds, figure))


def _differences(now: Sequence[EpisodeSummary], before: Sequence[EpisodeSummary], *, paired: bool) -> dict[str, float]:
    """Return the absolute difference of the means now and before, by the name of the figure.

    The figures are ``progress`` and ``reward``. The means are over the seeds that both ``now`` and
    ``before`` have, or over all episodes if these are not ``paired``.
    """
    count = min(len(now), len(before)) if paired else None
    pairs = {figure: (_values(now[:count], figure), _values(before[:count], figure)) for figure in FIGURES}
    return {figure: abs(fmean(new) - fmean(old)) for figure, (new, old) in pairs.items()}


def _changes(
    figures: Sequence[str],
    now: Sequence[EpisodeSummary],
    before: Sequence[EpisodeSummary],
    thresholds: Thresholds,
    error: float,
) -> Iterator[FigureChange]:
    """Yield a FigureChange for each of ``figures`` whose mean has certainly changed."""
    for figure in figures:
        values, old, threshold = _values(now, figure), fmean(_values(before, figure)), getattr(thresholds, figure)
        p_value = mean_p_value(values, old - threshold, old + threshold, *FIGURES[figure])
        if p_value <= error / (2 * len(FIGURES)):
            yield FigureChange(figure, old, fmean(values), p_value)


def _values(episodes: Sequence[EpisodeSummary], figure: str) -> list[float]:
    return list(map(attrgetter(figure), episodes))
