"""The search for ways, and the restarts on them."""

from __future__ import annotations

import os
import signal
import sys
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from tests.waiting import until_gone
from tltl_runtime.stealth.env import make_env
from tltl_runtime.training.exploration.replayed_starts import Episodes, EpisodeStart, Replayed
from tltl_runtime.training.exploration.reverse_curriculum import ReverseCurriculum
from tltl_runtime.training.exploration.search import (
    Exploration,
    FailedEpisode,
    Searched,
    SuccessfulEpisode,
    TrajectorySearch,
)
from tltl_runtime.vector import WorkerVectorEnv, make_vec
from tltl_runtime.vector.env import TLTL_INFO
from tltl_runtime.vector.errors import WorkerError
from tltlc.core.record import replace

NEAR = "import spatial\nentity s1\nspec near_s1 { level navigation  limit 300 steps  reach near(s1) }"
FAR = "import spatial\nentity exit\nspec out { level navigation  limit 300 steps  reach near(exit) }"


def envs(workers: int, spec: str = NEAR) -> WorkerVectorEnv:
    info = {**TLTL_INFO, "cell": np.int64}
    return make_vec("navigation", "v0", 4, workers, spec=spec, wrapper=Replayed, info=info)


@pytest.fixture
def env() -> Iterator[WorkerVectorEnv]:
    vector_env = envs(1)
    yield vector_env
    vector_env.close()


def search(env: WorkerVectorEnv, exploration: Exploration) -> tuple[list[SuccessfulEpisode], list[Searched]]:
    searching = TrajectorySearch(env, exploration, np.random.SeedSequence(7))
    reports = list(searching.run())
    return searching.ways, reports


def test_ways_meet_the_spec_when_they_are_replayed(env: WorkerVectorEnv) -> None:
    ways, reports = search(env, Exploration(ways=3, steps=20_000, parts=4, imitation=0))
    assert len(ways) >= 3
    assert reports[-1].lengths == tuple(sorted(len(way.actions) for way in ways))
    assert reports[-1].places > 10
    single_env = make_env("navigation", "v0", NEAR)
    assert {way.end for way in ways} == {1}
    for way in ways:
        single_env.reset(seed=way.seed)
        infos = [single_env.step(action)[4] for action in way.actions]
        assert [info["success"] for info in infos] == [False] * (len(infos) - 1) + [True]
    single_env.close()


def test_a_given_player_plays_first(env: WorkerVectorEnv) -> None:
    exploration = Exploration(ways=4, steps=20_000, parts=4, imitation=0)
    ways, reports = search(env, exploration)
    single_env = make_env("navigation", "v0", NEAR)
    ahead = []
    for way in ways:
        first, _ = single_env.reset(seed=way.seed)
        observations = [first, *(single_env.step(action)[0] for action in way.actions[:-1])]
        ahead.append(list(zip(observations, way.actions, strict=True)))
    single_env.close()

    def follow(observation: Mapping[str, NDArray[Any]]) -> NDArray[np.int64]:
        """The next action of the way that has this observation next, else no action."""
        for way in filter(None, ahead):
            if all(np.array_equal(observed, observation[name]) for name, observed in way[0][0].items()):
                return np.array(way.pop(0)[1])
        return np.zeros(5, np.int64)

    # Its first episodes have the same seeds as in the first search.
    searching = TrajectorySearch(env, replace(exploration, ways=1), np.random.SeedSequence(7), player=follow)
    (*_, last) = searching.run()
    assert searching.ways[0] in ways
    assert (last.steps, last.replayed) == (env.num_envs * len(searching.ways[0].actions), 0)
    assert last.steps < reports[-1].steps


def test_if_a_player_fails_the_search_continues_from_its_places(
    env: WorkerVectorEnv, monkeypatch: pytest.MonkeyPatch
) -> None:
    decisions: list[list[int]] = []
    starts: list[EpisodeStart] = []

    def walk(observation: Mapping[str, NDArray[Any]]) -> NDArray[np.int64]:
        """Walk away from the switch for 20 decisions of each environment, then stand still."""
        decisions.append([2, 1, 0, 0, 0] if len(decisions) < 20 * env.num_envs else [0, 0, 0, 0, 0])
        return np.array(decisions[-1])

    def drawn(search: TrajectorySearch) -> EpisodeStart:
        starts.append(draw(search))
        return starts[-1]

    draw = TrajectorySearch._draw
    monkeypatch.setattr(TrajectorySearch, "_draw", drawn)
    exploration = Exploration(ways=2, steps=20_000, parts=4, imitation=0)
    searching = TrajectorySearch(env, exploration, np.random.SeedSequence(7), player=walk)
    list(searching.run())
    assert len(searching.ways) >= 2
    # The episodes of the player end at the limit of 300 decisions.
    assert len(decisions) == env.num_envs * 300
    from_its_places = [start for start in starts if 0 < len(start.actions) <= 20]
    assert any([*start.actions] == decisions[:: env.num_envs][: len(start.actions)] for start in from_its_places)


def test_ways_are_found_from_failures(env: WorkerVectorEnv) -> None:
    exploration = Exploration(ways=2, steps=20_000, parts=4, imitation=0)
    # Failures are ways without their last three actions, shortly before the switch.
    failures = [FailedEpisode(way.seed, way.actions[:-3], 0) for way in search(env, exploration)[0]]
    searching = TrajectorySearch(env, exploration, np.random.SeedSequence(8), failures)
    steps = list(searching.run())[-1].steps
    assert {way.seed for way in searching.ways} == {failure.seed for failure in failures}
    for way in searching.ways:
        (failure,) = (candidate for candidate in failures if candidate.seed == way.seed)
        half = len(failure.actions) // 2
        assert way.actions[:half] == failure.actions[:half]
    assert steps < 5000
    elsewhere = [FailedEpisode(failure.seed, failure.actions, 1) for failure in failures]
    assert (
        list(TrajectorySearch(env, replace(exploration, steps=64), np.random.SeedSequence(8), elsewhere).run())[
            -1
        ].places
        == 0
    )


def test_any_number_of_workers_finds_the_same_ways(env: WorkerVectorEnv) -> None:
    exploration = Exploration(ways=2, steps=20_000, parts=4, imitation=0)
    other = envs(2)
    assert search(env, exploration)[0] == search(other, exploration)[0]
    other.close()


def test_a_search_ends_at_its_limit() -> None:
    env = envs(1, FAR)
    ways, reports = search(env, Exploration(ways=1, steps=200, parts=4, imitation=0))
    env.close()
    assert not ways
    assert reports[-1].steps == 200


def test_episodes_start_with_replayed_actions(env: WorkerVectorEnv) -> None:
    rng = np.random.default_rng(3)
    actions = [[int(choice) for choice in rng.integers(0, (3, 3, 1, 2, 2))] for _ in range(25)]
    starts = iter([EpisodeStart(5, actions[:20])] * 4 + [EpisodeStart(5, actions, most=2)] * 20)
    episodes = Episodes(env, lambda: next(starts))
    single_env = make_env("navigation", "v0", NEAR)
    single_env.reset(seed=5)
    for action in actions[:20]:
        observation, *_ = single_env.step(action)
    for key, value in observation.items():
        assert np.array_equal(episodes.observation[key], np.stack([value] * 4))
    for action in actions[20:]:
        episodes.step(np.array([action] * 4))
        observation, *_ = single_env.step(action)
    assert not any(episodes.is_spent(row) for row in range(4))
    # The next episodes start where these are now.
    cut = episodes.cut(np.array([True, False, False, True]))
    for key, value in observation.items():
        assert np.array_equal(cut[key], np.stack([value] * 4))
    assert episodes.actions[0] == episodes.actions[1] == actions
    assert episodes.replayed == 4 * 20 + 2 * 25
    for _ in range(2):
        episodes.step(np.zeros((4, 5), dtype=np.int64))
    assert [episodes.is_spent(row) for row in range(4)] == [True, False, False, True]
    single_env.close()


@pytest.mark.parametrize("prepared", [0, 1, 10, 1000])
def test_a_prepared_episode_equals_an_unprepared_one(prepared: int) -> None:
    actions = np.array([[2, 1, 0, 0, 0]] * 20, dtype=np.int8)
    env = Replayed(partial(make_env, "navigation", "v0", NEAR))
    env.begin = 4, actions
    # Preparation for an earlier start is discarded.
    assert all(env.prepare() for _ in range(5))
    env.begin = 5, actions
    assert sum(env.prepare() for _ in range(prepared)) == min(prepared, len(actions))
    first, info = env.reset()
    env.begin = 5, actions[:3]
    for _ in range(3):
        env.step(actions[0])
        env.prepare()
    env.reset()
    for action in actions[3:]:
        last, _, _, _, later = env.step(action)
    env.close()
    assert info == later
    assert all(np.array_equal(first[key], last[key]) for key in first)


@pytest.mark.skipif(sys.platform == "win32", reason="kills a process as other systems do")
@pytest.mark.parametrize(
    ("begun", "told"),
    [
        ([], [(0, 10, 1, 5), (1, 11, 1, 5), (2, 12, 1, 5), (3, 13, 1, 5)]),
        ([0, 3], [(0, 14, 1, 3), (1, 11, 1, 4), (2, 12, 1, 4), (3, 17, 1, 3)]),
    ],
)
def test_a_lost_worker_is_reported_with_the_seeds_of_its_episodes(
    env: WorkerVectorEnv, begun: list[int], told: list[tuple[int, ...]]
) -> None:
    starts = iter([EpisodeStart(seed, [[0] * 5] * 3) for seed in range(10, 20)])
    episodes = Episodes(env, lambda: next(starts))
    episodes.step(np.zeros((4, 5), dtype=np.int64))
    (worker,) = env.worker_pids
    assert worker is not None
    os.kill(worker, signal.SIGKILL)
    until_gone([worker])
    with pytest.raises(WorkerError) as caught:
        # The loss is detected in a step, or when episodes are cut.
        episodes.cut(np.isin(range(4), begun)) if begun else episodes.step(np.zeros((4, 5), dtype=np.int64))
    assert [(playing.env, playing.seed, playing.episode, playing.step) for playing in caught.value.playing] == told


def test_each_place_is_counted_once(env: WorkerVectorEnv) -> None:
    # After each way, the places of its seed are removed from the archive and can be found again.
    visited: set[tuple[int, int]] = set()
    step = env.step

    def noting_step(actions: NDArray[np.int64]) -> tuple[Any, ...]:
        step_result = step(actions)
        visited.update(zip(step_result[4]["state"].tolist(), step_result[4]["cell"].tolist(), strict=True))
        return step_result

    env.step = noting_step  # type: ignore[method-assign]
    ways, reports = search(env, Exploration(ways=8, steps=20_000, parts=4, imitation=0))
    assert len(ways) == 8
    assert len(visited) / 2 < reports[-1].places <= len(visited)


def restarts_of(ways: Sequence[SuccessfulEpisode], parts: int, seed: int = 1) -> ReverseCurriculum:
    restarts = ReverseCurriculum(parts, np.random.default_rng(seed))
    for way in ways:
        restarts.add(way)
    return restarts


def test_restarts_move_from_the_end_of_a_way_to_its_start() -> None:
    way = SuccessfulEpisode(1, [[0, 0, 0, 0, 0]] * 80, 1)
    restarts = restarts_of([way], 8, 0)

    def drawn() -> Counter[int | None]:
        parts = (restarts.draw().part for _ in range(1000))
        return Counter(None if part is None else part[1] for part in parts)

    first = drawn()
    assert first[7] == max(first.values())
    assert first[None] < 200
    longer = [[1, 0, 0, 0, 0]] * 90
    for part, times in ((7, 60), (6, 60), (5, 4)):
        for _ in range(times):
            restarts.ended(EpisodeStart(1, way.actions[: 10 * part], (1, part)), longer, 1)
    later = drawn()
    # Learned parts and parts far from them are drawn less often.
    assert later[5] > 2 * later[4] > 10 * max(later[7], later[6])
    assert later[4] > 1.3 * later[3] > 2 * later[1]
    for _ in range(500):
        restarts.ended(EpisodeStart(2), longer, 1)
    assert drawn()[None] > 800


@pytest.mark.parametrize(("from_start", "on_ways"), [(1, 150), (5, 700), (100, 100), (600, 5)])
def test_a_better_agent_starts_more_episodes_at_the_start_of_the_level(from_start: int, on_ways: int) -> None:
    shares = []
    for passed in (0.0, 0.5, 1.0):
        restarts = restarts_of([SuccessfulEpisode(1, [[0] * 5] * 80, 1)], 8)
        restarts.lengths[:] = from_start, on_ways
        restarts.passed = passed
        shares.append(sum(restarts.draw().part is None for _ in range(2000)) / 2000)
    assert shares[0] <= shares[1] + 0.03
    assert shares[1] <= shares[2] + 0.03
    assert 0.95 < shares[2] < 0.99


@pytest.mark.parametrize("length", [30, 90, 900])
def test_a_fifth_of_the_decisions_is_in_episodes_from_the_start_of_the_level(length: int) -> None:
    way = SuccessfulEpisode(1, [[0] * 5] * 80, 1)
    restarts = restarts_of([way], 8)
    decisions = Counter[bool]()
    for index in range(6000):
        start = restarts.draw()
        decision_count = 40 if start.part else length
        restarts.ended(start, [*start.actions, *[[0] * 5] * decision_count], None)
        if index >= 2000:
            decisions[start.part is None] += decision_count
    assert 0.15 < decisions[True] / decisions.total() < 0.25


def test_the_last_32_failures_from_the_start_of_the_level_are_kept() -> None:
    restarts = restarts_of([SuccessfulEpisode(1, [[0] * 5] * 80, 1)], 8)
    for seed in range(40):
        restarts.ended(EpisodeStart(seed), [[0] * 5] * 9, None, 2)
        restarts.ended(EpisodeStart(seed, part=(1, 3)), [[0] * 5] * 9, None, 2)
        restarts.ended(EpisodeStart(seed), [[0] * 5] * 9, 1, 3)
        restarts.ended(EpisodeStart(seed), [[0] * 5] * 9, None)
    assert [(failure.seed, failure.state) for failure in restarts.failures] == [(seed, 2) for seed in range(8, 40)]


def test_a_start_lies_in_its_part_and_leaves_enough_time() -> None:
    way = SuccessfulEpisode(9, [[0, 0, 0, 0, index % 2] for index in range(160)], 1)
    restarts = restarts_of([way], 16)
    for start in (restarts.draw() for _ in range(300)):
        if start.part is not None:
            end, part = start.part
            assert end == 1
            assert part * 10 <= len(start.actions) < (part + 1) * 10
            assert start.actions == way.actions[: len(start.actions)]
            assert start.most is not None
            assert start.most >= 160 - len(start.actions)


def test_the_shortest_ways_to_each_end_are_kept() -> None:
    ways = [SuccessfulEpisode(index, [[0] * 5] * (100 + index), index % 2) for index in range(20)]
    ways += [SuccessfulEpisode(0, [[0] * 5] * length, 0) for length in (99, 150)]
    restarts = restarts_of(ways, 4)
    restarts.ended(EpisodeStart(77), [[1] * 5] * 50, 0)
    restarts.ended(EpisodeStart(78), [[1] * 5] * 40, None)
    restarts.ended(EpisodeStart(79), [[1] * 5] * 400, 3)
    kept = {end: [way.seed for way in ways_to_end] for end, ways_to_end in restarts.ways.items()}
    assert kept == {0: [77, 0, 2, 4, 6, 8], 1: [1, 3, 5, 7, 9, 11], 3: [79]}
    assert [len(way.actions) for way in restarts.ways[0]] == [50, 99, 102, 104, 106, 108]
    assert {start.part[0] for start in (restarts.draw() for _ in range(200)) if start.part} == {0, 1, 3}


def test_without_ways_episodes_start_at_the_start_of_the_level() -> None:
    restarts = restarts_of([], 4)
    assert all(start.part is None and not start.actions for start in (restarts.draw() for _ in range(50)))


@pytest.mark.parametrize("count", [0, 3])
def test_the_saved_state_of_restarts_is_complete(count: int) -> None:
    ways = [SuccessfulEpisode(index, [[index, 0, 1, 0, 1]] * (5 + index), index) for index in range(count)]
    restarts = restarts_of(ways, 4)
    if count:
        restarts.ended(EpisodeStart(3, (), (2, 2)), [], None)
    restarts.ended(EpisodeStart(3), [[0] * 5] * 200, None)
    for seed in range(count):
        restarts.ended(EpisodeStart(seed), [[seed, 0, 1, 0, 1]] * (3 + seed), None, 1)
    again = restarts_of([], 4)
    again.load(restarts.state())
    assert again.failures == restarts.failures
    assert again.ways == restarts.ways
    assert {end: rates.tolist() for end, rates in again.rates.items()} == {
        end: rates.tolist() for end, rates in restarts.rates.items()
    }
    assert again.passed == restarts.passed
    assert again.lengths.tolist() == restarts.lengths.tolist()
    assert [again.draw() for _ in range(9)] == [restarts.draw() for _ in range(9)]
