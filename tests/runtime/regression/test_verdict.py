"""The rule of the verdicts, one test for each of its sentences in docs/regression.md."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.runtime.regression.handmade import summaries, summary
from tltl_runtime.regression.suite.suite import LEAST_EPISODES, Thresholds
from tltl_runtime.regression.verdict.confidence import rate_interval
from tltl_runtime.regression.verdict.verdict import Judgement, differing_figures, judge
from tltl_runtime.spec.episode_summary import EpisodeSummary
from tltlc.core.record import replace

ERROR = 0.05
DEFAULT = Thresholds()


def judged(
    now: Sequence[EpisodeSummary],
    before: Sequence[EpisodeSummary] = (),
    episodes: int = 300,
    thresholds: Thresholds = DEFAULT,
    error: float = ERROR,
) -> Judgement | None:
    return judge(now, before or [summary(episode.index) for episode in now], episodes, thresholds, error)


def first(
    now: Sequence[EpisodeSummary], before: Sequence[EpisodeSummary] = (), error: float = ERROR
) -> tuple[int, Judgement]:
    """The number of episodes after which there is a verdict, and the verdict."""
    for count in range(1, len(now) + 1):
        judgement = judged(now[:count], before, len(now), error=error)
        if judgement:
            return count, judgement
    raise AssertionError("the last episode settles every verdict")


@pytest.mark.parametrize("count", [1, 10, LEAST_EPISODES - 1])
def test_nothing_is_decided_before_25_episodes(count: int) -> None:
    assert LEAST_EPISODES == 25
    assert judged(summaries(count)) is None
    assert judged(summaries(0, count)) is None
    assert judged(summaries(0, count), episodes=count) is None


def test_fail_if_the_rate_is_certainly_below_fail_rate() -> None:
    count, judgement = first(summaries(0, 40))
    assert (count, judgement.verdict, judgement.certain) == (25, "fail", True)
    assert judgement.rate_interval[1] < DEFAULT.fail_rate
    # 15 of 40 is less than half, but not certainly.
    assert rate_interval(15, 25, ERROR)[1] >= 0.5
    assert judged(summaries(15, 25)) is None


def test_fail_takes_precedence_over_changes() -> None:
    judgement = judged(summaries(0, 25), [summary(index) for index in range(25)])
    assert judgement is not None and judgement.verdict == "fail"
    assert [change.figure for change in judgement.changes] == ["progress", "reward"]


def test_review_if_the_rate_is_certainly_in_between() -> None:
    low, high = rate_interval(140, 60, ERROR)
    assert DEFAULT.fail_rate <= low and high < DEFAULT.pass_rate
    alike = summaries(140, 60)
    judgement = judged(alike, alike)
    assert judgement == Judgement("review", True, (low, high), ())


def test_review_if_a_figure_has_certainly_changed() -> None:
    before = summaries(300)
    for figure, value in (("reward", 0.45), ("progress", 0.8)):
        now = [replace(episode, **{figure: value}) for episode in before]
        count, judgement = first(now, before)
        assert (judgement.verdict, judgement.certain) == ("review", True)
        assert count < 60
        (change,) = judgement.changes
        assert change.figure == figure and change.now == pytest.approx(value)
        assert change.before == pytest.approx(getattr(before[0], figure))
        assert change.p_value <= ERROR / 4


def test_an_improvement_is_a_change() -> None:
    before = summaries(300)
    _, judgement = first([replace(episode, reward=0.95) for episode in before], before)
    assert judgement.verdict == "review" and judgement.changes[0].now > judgement.changes[0].before


def noisy(mean: float, spread: float, seed: int, count: int = 200) -> list[EpisodeSummary]:
    """Episodes of which 2 % fail; the rewards of the others are normal with this mean and deviation."""
    rng = np.random.default_rng(seed)
    met, rewards = rng.random(count) < 0.98, rng.normal(mean, spread, count)
    return [
        summary(index, bool(met[index]), reward=float(rewards[index].clip(-1, 1)) if met[index] else -0.3)
        for index in range(count)
    ]


def found_changed(drop: float, spread: float, cases: int = 40) -> int:
    """The number of cases in which a drop of the reward is found certain, with a check every 25 episodes."""
    pairs = [(noisy(0.7 - drop, spread, seed), noisy(0.7, spread, 1000 + seed)) for seed in range(cases)]
    looks = [[judged(now[:count], before) for count in range(25, len(now) + 1, 25)] for now, before in pairs]
    return sum(any(judgement is not None and judgement.changes for judgement in judgements) for judgements in looks)


@pytest.mark.parametrize(("drop", "spread"), [(0.04, 0.05), (0.045, 0.1), (0.0, 0.15)])
def test_a_change_below_its_threshold_is_rarely_certain(drop: float, spread: float) -> None:
    assert found_changed(drop, spread) <= 2


def test_a_change_above_its_threshold_is_certain() -> None:
    assert found_changed(0.12, 0.05) >= 38


def test_an_uncertain_change_at_the_end_is_reviewed() -> None:
    before = [replace(episode, reward=0.9 if episode.index % 2 else 0.5) for episode in summaries(200)]
    now = [replace(episode, reward=episode.reward - 0.053) for episode in before]
    judgement = judged(now, before, episodes=200)
    assert judgement == Judgement("review", False, rate_interval(200, 0, ERROR), ())
    assert differing_figures(now, before, DEFAULT) == ("reward",)
    assert judged(
        [replace(episode, reward=episode.reward + 0.005) for episode in now], before, episodes=200
    ) == Judgement("pass", False, rate_interval(200, 0, ERROR), ())


def test_the_episodes_of_the_baseline_have_not_changed_in_any_order() -> None:
    """The worst case: the first episodes are unlike the mean of the baseline."""
    before = [replace(episode, reward=0.3 if episode.index < 60 else 0.7) for episode in summaries(300)]
    assert first(before, before) == (29, Judgement("pass", True, rate_interval(29, 0, ERROR), ()))


def test_a_larger_threshold_tolerates_a_change() -> None:
    before = summaries(300)
    now = [replace(episode, reward=0.4) for episode in before]
    judgement = judged(now[:60], before, thresholds=Thresholds(reward=0.7))
    assert judgement is not None and (judgement.verdict, judgement.changes) == ("pass", ())


def test_equal_episodes_have_not_changed_with_thresholds_of_zero() -> None:
    episodes = [replace(summary(index), reward=0.3 if index < 40 else 0.9) for index in range(300)]
    strict = replace(DEFAULT, progress=0.0, reward=0.0)
    judgements = [judge(episodes[:count], episodes, 300, strict, 0.05) for count in range(25, 60)]
    assert [judgement.verdict for judgement in judgements if judgement][:1] == ["pass"]
    assert not any(judgement.changes for judgement in judgements if judgement)


def test_pass_if_the_rate_is_certain_and_the_figures_are_alike() -> None:
    count, judgement = first(summaries(300))
    assert (count, judgement.verdict, judgement.certain, judgement.changes) == (29, "pass", True, ())
    assert judgement.rate_interval[0] >= DEFAULT.pass_rate > rate_interval(count - 1, 0, ERROR)[0]


@pytest.mark.parametrize("cases, count", [(1, 29), (9, 43), (30, 51)])
def test_more_cases_need_more_episodes(cases: int, count: int) -> None:
    assert first(summaries(100), error=0.05 / cases)[0] == count


def test_pass_waits_while_the_figures_differ_by_more_than_half_of_their_thresholds() -> None:
    before = summaries(300)
    for difference, verdict in ((0.024, "pass"), (0.026, None)):
        now = [replace(episode, reward=episode.reward - difference) for episode in before]
        judgement = judged(now[:100], before)
        assert (judgement.verdict if judgement else None) == verdict


def test_if_nothing_is_certain_the_rate_decides_at_the_end() -> None:
    before = summaries(300)
    other = [replace(episode, reward=episode.reward - 0.04) for episode in before]
    assert judged(other, before) == Judgement("pass", False, rate_interval(300, 0, ERROR), ())
    low, high = rate_interval(260, 40, ERROR)
    assert low < DEFAULT.pass_rate < high
    alike = summaries(260, 40)
    assert judged(alike, alike) == Judgement("review", False, (low, high), ())


def test_only_the_episodes_that_the_baseline_has_are_compared() -> None:
    before = summaries(25)
    now = [*summaries(25), *[replace(episode, reward=-1.0) for episode in summaries(35)]]
    judgement = judged(now, before)
    assert judgement is not None and (judgement.verdict, judgement.changes) == ("pass", ())


@given(st.lists(st.tuples(st.booleans(), st.floats(0, 1), st.floats(-1, 1)), min_size=25, max_size=60))
def test_the_last_episode_settles_every_verdict(drawn: list[tuple[bool, float, float]]) -> None:
    now = [summary(index, met, progress=done, reward=got) for index, (met, done, got) in enumerate(drawn)]
    judgement = judged(now, episodes=len(now))
    assert judgement is not None
    low, high = judgement.rate_interval
    assert low <= sum(met for met, _, _ in drawn) / len(drawn) <= high
    if judgement.verdict == "pass":
        assert low >= DEFAULT.pass_rate and not judgement.changes
