"""The windows of episodes: when the spec counts as met, the score of a policy, and standstills."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tltl_runtime.spec.episode_summary import EpisodeSummary
from tltl_runtime.training.files.report import EpisodeWindow
from tltl_runtime.training.ppo.recent_episodes import RecentEpisodes, Standstill

SUCCESS = EpisodeSummary(0, None, True, "success", 1.0, 0.6, 40, 4)
FAILURE = EpisodeSummary(1, None, False, "violation", 0.6, -0.4, 25, 2)


def _windows(episodes: list[bool]) -> RecentEpisodes:
    windows = RecentEpisodes(2, 3, 100)
    windows.add(SUCCESS if success else FAILURE for success in episodes)
    return windows


@given(st.lists(st.booleans(), max_size=20))
def test_the_spec_is_met_after_two_windows_of_successes(episodes: list[bool]) -> None:
    assert _windows(episodes).all_met == (len(episodes) >= 6 and all(episodes[-6:]))


def test_after_a_failed_confirmation_counting_starts_again() -> None:
    windows = _windows([True] * 6)
    windows.reset_unbroken()
    windows.add([SUCCESS] * 5)
    assert (windows.all_met, windows.unbroken, windows.window.successes) == (False, 5, 6)
    windows.add([SUCCESS])
    assert windows.all_met


@given(st.lists(st.booleans(), max_size=20))
def test_a_policy_is_scored_by_its_last_window(episodes: list[bool]) -> None:
    score = _windows(episodes).score
    if len(episodes) < 3:
        assert score is None
    else:
        assert score is not None
        assert score[0] == pytest.approx(sum(episodes[-3:]) / 3)


def test_rewards_use_the_undiscounted_penalty() -> None:
    windows = RecentEpisodes(2, 3, 100)
    windows.load(_windows([True, False]).state(), 0)
    window = windows.window
    # 1 - 40/100, and 0.6 - 1.
    assert window.reward == pytest.approx((0.6 - 0.4) / 2)
    assert (window.count, window.successes, window.pass_rate) == (2, 1, 0.5)
    assert (window.progress, window.steps, window.states) == (0.8, 32.5, {2: 0.5, 4: 0.5})
    assert window.violated == {2: 0.5}


def test_a_window_without_episodes_has_zero_figures() -> None:
    window = _windows([]).window
    assert (window.count, window.pass_rate, window.reward, window.states, window.violated) == (0, 0.0, 0.0, {}, {})


@given(st.lists(st.booleans(), max_size=12), st.lists(st.booleans(), max_size=12))
def test_loaded_windows_continue(before: list[bool], after: list[bool]) -> None:
    # What the windows have before does not count.
    windows = _windows(after)
    windows.load(_windows(before).state(), _windows(before).unbroken)
    windows.add(SUCCESS if success else FAILURE for success in after)
    whole = _windows(before + after)
    assert (windows.state(), windows.unbroken) == (whole.state(), whole.unbroken)


def window_of(successes: int) -> EpisodeWindow:
    return EpisodeWindow(100, successes, 0.5, 0.1, 100.0, {}, {})


def test_a_standstill_is_a_pass_rate_that_no_longer_rises() -> None:
    standstill = Standstill()
    assert not standstill.add(EpisodeWindow(2, 1, 0.5, 0.1, 100.0, {}, {}), 0)
    rates = [(0, 0), (150_000, 0), (200_000, 9), (250_000, 40), (300_000, 44), (340_000, 38)]
    assert not any(standstill.add(window_of(successes), steps) for steps, successes in rates)
    assert standstill.add(window_of(44), 350_000)
    assert not standstill.add(window_of(44), 449_999), "it counts anew"
    assert Standstill(*standstill.state()).add(window_of(30), 450_000), "one that is resumed, too"
    assert standstill.add(window_of(30), 450_000)
    assert not standstill.add(window_of(50), 549_999), "it has risen"
    assert not standstill.add(window_of(80), 600_000)
    assert not standstill.add(window_of(70), 900_000), "little is left to be found"
