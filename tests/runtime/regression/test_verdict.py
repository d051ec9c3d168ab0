"""The rule of the verdicts, one test for each of its sentences in docs/regression.md."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.runtime.regression.made import made, several
from tltl_runtime.regression.explain.account import Account
from tltl_runtime.regression.suite.suite import LEAST_EPISODES, Thresholds
from tltl_runtime.regression.verdict.confidence import rate_interval
from tltl_runtime.regression.verdict.verdict import Judgement, beyond, judge
from tltlc.core.record import replace

ERROR = 0.05
DEFAULT = Thresholds()


def judged(
    now: Sequence[Account],
    before: Sequence[Account] = (),
    episodes: int = 300,
    thresholds: Thresholds = DEFAULT,
    error: float = ERROR,
) -> Judgement | None:
    return judge(now, before or [made(each.index) for each in now], episodes, thresholds, error)


def first(now: Sequence[Account], before: Sequence[Account] = (), error: float = ERROR) -> tuple[int, Judgement]:
    """After how many episodes there is a verdict, and which one."""
    for count in range(1, len(now) + 1):
        found = judged(now[:count], before, len(now), error=error)
        if found:
            return count, found
    raise AssertionError("the last episode settles every verdict")


@pytest.mark.parametrize("count", [1, 10, LEAST_EPISODES - 1])
def test_nothing_is_decided_before_25_episodes(count: int) -> None:
    assert LEAST_EPISODES == 25
    assert judged(several(count)) is None
    assert judged(several(0, count)) is None
    assert judged(several(0, count), episodes=count) is None


def test_fail_where_the_rate_is_certainly_below_fail_rate() -> None:
    count, found = first(several(0, 40))
    assert (count, found.verdict, found.certain) == (25, "fail", True)
    assert found.rate_interval[1] < DEFAULT.fail_rate
    # 15 of 40 are less than a half, and not certainly so.
    assert rate_interval(15, 25, ERROR)[1] >= 0.5
    assert judged(several(15, 25)) is None


def test_fail_comes_before_changes() -> None:
    found = judged(several(0, 25), [made(index) for index in range(25)])
    assert found is not None and found.verdict == "fail"
    assert [change.figure for change in found.changes] == ["progress", "reward"]


def test_review_where_the_rate_is_certainly_between() -> None:
    low, high = rate_interval(140, 60, ERROR)
    assert DEFAULT.fail_rate <= low and high < DEFAULT.pass_rate
    alike = several(140, 60)
    found = judged(alike, alike)
    assert found == Judgement("review", True, (low, high), ())


def test_review_where_a_figure_has_certainly_changed() -> None:
    before = several(300)
    for figure, value in (("reward", 0.45), ("progress", 0.8)):
        now = [replace(each, **{figure: value}) for each in before]
        count, found = first(now, before)
        assert (found.verdict, found.certain) == ("review", True)
        assert count < 60
        (change,) = found.changes
        assert change.figure == figure and change.now == pytest.approx(value)
        assert change.before == pytest.approx(getattr(before[0], figure))
        assert change.p_value <= ERROR / 4


def test_what_is_better_than_before_has_changed_too() -> None:
    before = several(300)
    _, found = first([replace(each, reward=0.95) for each in before], before)
    assert found.verdict == "review" and found.changes[0].now > found.changes[0].before


def noisy(mean: float, spread: float, seed: int, count: int = 200) -> list[Account]:
    """Episodes of which one in fifty fails; the reward of the others has that mean and spread."""
    rng = np.random.default_rng(seed)
    met, drawn = rng.random(count) < 0.98, rng.normal(mean, spread, count)
    return [
        made(index, bool(met[index]), reward=float(drawn[index].clip(-1, 1)) if met[index] else -0.3)
        for index in range(count)
    ]


def found_changed(drop: float, spread: float, cases: int = 40) -> int:
    """In how many cases a reward that falls by ``drop`` has certainly changed, looked at every 25 episodes."""
    pairs = [(noisy(0.7 - drop, spread, seed), noisy(0.7, spread, 1000 + seed)) for seed in range(cases)]
    looks = [[judged(now[:count], before) for count in range(25, len(now) + 1, 25)] for now, before in pairs]
    return sum(any(found is not None and found.changes for found in each) for each in looks)


@pytest.mark.parametrize(("drop", "spread"), [(0.04, 0.05), (0.045, 0.1), (0.0, 0.15)])
def test_a_change_below_its_threshold_is_seldom_certain_whatever_the_noise(drop: float, spread: float) -> None:
    assert found_changed(drop, spread) <= 2


def test_a_change_that_is_greater_than_its_threshold_is_certain() -> None:
    assert found_changed(0.12, 0.05) >= 38


def test_what_seems_to_have_changed_in_the_end_is_reviewed() -> None:
    before = [replace(each, reward=0.9 if each.index % 2 else 0.5) for each in several(200)]
    now = [replace(each, reward=each.reward - 0.053) for each in before]
    found = judged(now, before, episodes=200)
    assert found == Judgement("review", False, rate_interval(200, 0, ERROR), ())
    assert beyond(now, before, DEFAULT) == ("reward",)
    assert judged([replace(each, reward=each.reward + 0.005) for each in now], before, episodes=200) == Judgement(
        "pass", False, rate_interval(200, 0, ERROR), ()
    )


def test_episodes_that_are_the_baselines_have_not_changed_however_they_begin() -> None:
    """The worst luck: those come first that are unlike the mean that was recorded."""
    before = [replace(each, reward=0.3 if each.index < 60 else 0.7) for each in several(300)]
    assert first(before, before) == (29, Judgement("pass", True, rate_interval(29, 0, ERROR), ()))


def test_a_change_is_none_where_the_designer_says_so() -> None:
    before = several(300)
    now = [replace(each, reward=0.4) for each in before]
    found = judged(now[:60], before, thresholds=Thresholds(reward=0.7))
    assert found is not None and (found.verdict, found.changes) == ("pass", ())


def test_what_is_the_same_has_not_changed_whatever_the_designer_says() -> None:
    episodes = [replace(made(index), reward=0.3 if index < 40 else 0.9) for index in range(300)]
    strict = replace(DEFAULT, progress=0.0, reward=0.0)
    found = [judge(episodes[:count], episodes, 300, strict, 0.05) for count in range(25, 60)]
    assert [each.verdict for each in found if each][:1] == ["pass"]
    assert not any(each.changes for each in found if each)


def test_pass_where_the_rate_is_certain_and_the_figures_are_alike() -> None:
    count, found = first(several(300))
    assert (count, found.verdict, found.certain, found.changes) == (29, "pass", True, ())
    assert found.rate_interval[0] >= DEFAULT.pass_rate > rate_interval(count - 1, 0, ERROR)[0]


@pytest.mark.parametrize("cases, count", [(1, 29), (9, 43), (30, 51)])
def test_more_cases_ask_for_more_episodes(cases: int, count: int) -> None:
    assert first(several(100), error=0.05 / cases)[0] == count


def test_pass_waits_while_the_figures_differ_by_more_than_half_of_their_thresholds() -> None:
    before = several(300)
    for difference, verdict in ((0.024, "pass"), (0.026, None)):
        now = [replace(each, reward=each.reward - difference) for each in before]
        found = judged(now[:100], before)
        assert (found.verdict if found else None) == verdict


def test_where_nothing_is_certain_the_rate_decides_in_the_end() -> None:
    before = several(300)
    other = [replace(each, reward=each.reward - 0.04) for each in before]
    assert judged(other, before) == Judgement("pass", False, rate_interval(300, 0, ERROR), ())
    low, high = rate_interval(260, 40, ERROR)
    assert low < DEFAULT.pass_rate < high
    alike = several(260, 40)
    assert judged(alike, alike) == Judgement("review", False, (low, high), ())


def test_only_the_episodes_that_the_baseline_has_are_compared() -> None:
    before = several(25)
    now = [*several(25), *[replace(each, reward=-1.0) for each in several(35)]]
    found = judged(now, before)
    assert found is not None and (found.verdict, found.changes) == ("pass", ())


@given(st.lists(st.tuples(st.booleans(), st.floats(0, 1), st.floats(-1, 1)), min_size=25, max_size=60))
def test_the_last_episode_settles_every_verdict(drawn: list[tuple[bool, float, float]]) -> None:
    now = [made(index, met, progress=done, reward=got) for index, (met, done, got) in enumerate(drawn)]
    found = judged(now, episodes=len(now))
    assert found is not None
    low, high = found.rate_interval
    assert low <= sum(met for met, _, _ in drawn) / len(drawn) <= high
    if found.verdict == "pass":
        assert low >= DEFAULT.pass_rate and not found.changes
