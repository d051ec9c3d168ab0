"""The path of an episode, simplified to few points."""

from __future__ import annotations

from math import dist

import numpy as np
import pytest

from tests.runtime.regression.page import samples
from tltl_runtime.regression.explain.path_points import POSITION_INTERVAL_S, positions_along, simplified_trajectory
from tltl_runtime.stealth.recordings.episode import Episode

EPISODES = ("navigation", "branching", "cover_and_hide_met", "cover_and_hide_failed")


@pytest.fixture(params=EPISODES, name="episode", scope="module")
def _episode(request: pytest.FixtureRequest) -> Episode:
    episodes: tuple[Episode, ...] = getattr(samples, request.param)()
    return episodes[0]


def test_the_path_is_close_to_the_player_at_all_times(episode: Episode) -> None:
    way = simplified_trajectory(episode)
    times = [time for *_, time in way]
    assert times == sorted(set(times))
    for shot in episode.snapshots:
        place = [np.interp(shot.time, times, [point[axis] for point in way]) for axis in (0, 1)]
        assert dist(place, shot.player.position[:2]) < 0.22


def test_the_path_has_few_points(episode: Episode) -> None:
    assert len(simplified_trajectory(episode)) < 0.7 * len(episode.snapshots)


def test_each_point_has_the_state_of_its_time(episode: Episode) -> None:
    way = simplified_trajectory(episode)
    states_by_time = {
        round(shot.time, 2): int(state) for shot, state in zip(episode.snapshots, episode.states, strict=True)
    }
    assert all(state == states_by_time[time] for *_, state, time in way)
    for step in np.flatnonzero(np.diff(episode.states)) + 1:
        assert round(episode.snapshots[step].time, 2) in {time for *_, time in way}


def test_the_places_cover_the_whole_episode(episode: Episode) -> None:
    places = list(positions_along(simplified_trajectory(episode)))
    assert len(places) == pytest.approx(episode.snapshots[-1].time / POSITION_INTERVAL_S, abs=1)
    assert places[0] == pytest.approx(episode.snapshots[0].player.position[:2], abs=0.01)


def test_a_player_that_stands_still_stays_in_one_place() -> None:
    assert list(positions_along(((2.0, 3.0, 0, 0.0), (2.0, 3.0, 0, 0.5)))) == [(2.0, 3.0)] * 5
