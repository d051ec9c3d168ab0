"""The search for demonstrations, and the reverse curriculum that starts episodes on them."""

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

from tests.runtime.training.runs import STEALTH_ACTIONS
from tests.waiting import until_gone
from tltl_runtime.stealth.env import make_env
from tltl_runtime.training.exploration.replayed_starts import EpisodesInProgress, EpisodeStart, ReplayedStartEnv
from tltl_runtime.training.exploration.reverse_curriculum import ReverseCurriculum
from tltl_runtime.training.exploration.search import (
    FailedEpisode,
    SearchProgress,
    SearchSettings,
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
    return make_vec("navigation", "v0", 4, workers, spec=spec, wrapper=ReplayedStartEnv, info=info)


@pytest.fixture
def env() -> Iterator[WorkerVectorEnv]:
    vector_env = envs(1)
    yield vector_env
    vector_env.close()


def run_search(
    env: WorkerVectorEnv, exploration: SearchSettings
) -> tuple[list[SuccessfulEpisode], list[SearchProgress]]:
    search = TrajectorySearch(env, exploration, np.random.SeedSequence(7))
    reports = list(search.run())
    return search.demonstrations, reports


def test_demonstrations_meet_the_spec_when_they_are_replayed(env: WorkerVectorEnv) -> None:
    demonstrations, reports = run_search(env, SearchSettings(ways=3, steps=20_000, parts=4, imitation=0))
    assert len(demonstrations) >= 3
    assert reports[-1].lengths == tuple(sorted(len(demonstration.actions) for demonstration in demonstrations))
    assert reports[-1].places > 10
    single_env = make_env("navigation", "v0", NEAR)
    assert {demonstration.end for demonstration in demonstrations} == {1}
    for demonstration in demonstrations:
        single_env.reset(seed=demonstration.seed)
        infos = [single_env.step(action)[4] for action in demonstration.actions]
        assert [info["success"] for info in infos] == [False] * (len(infos) - 1) + [True]
    single_env.close()


def test_a_given_player_plays_first(env: WorkerVectorEnv) -> None:
    exploration = SearchSettings(ways=4, steps=20_000, parts=4, imitation=0)
    demonstrations, reports = run_search(env, exploration)
    single_env = make_env("navigation", "v0", NEAR)
    ahead = []
    for demonstration in demonstrations:
        first, _ = single_env.reset(seed=demonstration.seed)
        observations = [first, *(single_env.step(action)[0] for action in demonstration.actions[:-1])]
        ahead.append(list(zip(observations, demonstration.actions, strict=True)))
    single_env.close()

    def follow(observation: Mapping[str, NDArray[Any]]) -> NDArray[np.int64]:
        """The next action of the demonstration that has this observation next, else no action."""
        for demonstration in filter(None, ahead):
            if all(np.array_equal(observed, observation[name]) for name, observed in demonstration[0][0].items()):
                return np.array(demonstration.pop(0)[1])
        return np.zeros(5, np.int64)

    # Its first episodes have the same seeds as in the first search.
    search = TrajectorySearch(env, replace(exploration, ways=1), np.random.SeedSequence(7), policy=follow)
    (*_, last) = search.run()
    assert search.demonstrations[0] in demonstrations
    assert (last.steps, last.replayed) == (env.num_envs * len(search.demonstrations[0].actions), 0)
    assert last.steps < reports[-1].steps


def test_if_a_player_fails_the_search_continues_from_its_cells(
    env: WorkerVectorEnv, monkeypatch: pytest.MonkeyPatch
) -> None:
    decisions: list[list[int]] = []
    starts: list[EpisodeStart] = []

    def walk(observation: Mapping[str, NDArray[Any]]) -> NDArray[np.int64]:
        """Walk away from the switch for 20 decisions of each environment, then stand still."""
        decisions.append([2, 1, 0, 0, 0] if len(decisions) < 20 * env.num_envs else [0, 0, 0, 0, 0])
        return np.array(decisions[-1])

    def recorded_draw(search: TrajectorySearch) -> EpisodeStart:
        starts.append(draw(search))
        return starts[-1]

    draw = TrajectorySearch._draw
    monkeypatch.setattr(TrajectorySearch, "_draw", recorded_draw)
    exploration = SearchSettings(ways=2, steps=20_000, parts=4, imitation=0)
    search = TrajectorySearch(env, exploration, np.random.SeedSequence(7), policy=walk)
    list(search.run())
    assert len(search.demonstrations) >= 2
    # The episodes of the player end at the limit of 300 decisions.
    assert len(decisions) == env.num_envs * 300
    from_its_cells = [start for start in starts if 0 < len(start.actions) <= 20]
    assert any([*start.actions] == decisions[:: env.num_envs][: len(start.actions)] for start in from_its_cells)


def test_a_search_from_failures_finds_demonstrations_with_their_seeds(env: WorkerVectorEnv) -> None:
    exploration = SearchSettings(ways=2, steps=20_000, parts=4, imitation=0)
    # Failures are demonstrations without their last three actions, shortly before the switch.
    failures = [
        FailedEpisode(demonstration.seed, demonstration.actions[:-3], 0)
        for demonstration in run_search(env, exploration)[0]
    ]
    search = TrajectorySearch(env, exploration, np.random.SeedSequence(8), failures)
    steps = list(search.run())[-1].steps
    assert {demonstration.seed for demonstration in search.demonstrations} == {failure.seed for failure in failures}
    for demonstration in search.demonstrations:
        (failure,) = (candidate for candidate in failures if candidate.seed == demonstration.seed)
        half = len(failure.actions) // 2
        assert demonstration.actions[:half] == failure.actions[:half]
    assert steps < 5000
    elsewhere = [FailedEpisode(failure.seed, failure.actions, 1) for failure in failures]
    assert (
        list(TrajectorySearch(env, replace(exploration, steps=64), np.random.SeedSequence(8), elsewhere).run())[
            -1
        ].places
        == 0
    )


def test_any_number_of_workers_finds_the_same_demonstrations(env: WorkerVectorEnv) -> None:
    exploration = SearchSettings(ways=2, steps=20_000, parts=4, imitation=0)
    other = envs(2)
    assert run_search(env, exploration)[0] == run_search(other, exploration)[0]
    other.close()


def test_a_search_ends_at_its_limit() -> None:
    env = envs(1, FAR)
    demonstrations, reports = run_search(env, SearchSettings(ways=1, steps=200, parts=4, imitation=0))
    env.close()
    assert not demonstrations
    assert reports[-1].steps == 200


def test_episodes_start_with_replayed_actions(env: WorkerVectorEnv) -> None:
    rng = np.random.default_rng(3)
    actions = [[int(choice) for choice in rng.integers(0, (3, 3, 1, 2, 2))] for _ in range(25)]
    starts = iter([EpisodeStart(5, actions[:20])] * 4 + [EpisodeStart(5, actions, max_decisions=2)] * 20)
    episodes = EpisodesInProgress(env, lambda: next(starts))
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
    cut = episodes.cut_off(np.array([True, False, False, True]))
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
    env = ReplayedStartEnv(partial(make_env, "navigation", "v0", NEAR))
    env.next_start = 4, actions
    # Preparation for an earlier start is discarded.
    assert all(env.prepare() for _ in range(5))
    env.next_start = 5, actions
    assert sum(env.prepare() for _ in range(prepared)) == min(prepared, len(actions))
    first, info = env.reset()
    env.next_start = 5, actions[:3]
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
    ("cut_rows", "expected"),
    [
        ([], [(0, 10, 1, 5), (1, 11, 1, 5), (2, 12, 1, 5), (3, 13, 1, 5)]),
        ([0, 3], [(0, 14, 1, 3), (1, 11, 1, 4), (2, 12, 1, 4), (3, 17, 1, 3)]),
    ],
)
def test_a_lost_worker_is_reported_with_the_seeds_of_its_episodes(
    env: WorkerVectorEnv, cut_rows: list[int], expected: list[tuple[int, ...]]
) -> None:
    starts = iter([EpisodeStart(seed, [[0] * 5] * 3) for seed in range(10, 20)])
    episodes = EpisodesInProgress(env, lambda: next(starts))
    episodes.step(np.zeros((4, 5), dtype=np.int64))
    (worker,) = env.worker_pids
    assert worker is not None
    os.kill(worker, signal.SIGKILL)
    until_gone([worker])
    with pytest.raises(WorkerError) as caught:
        # The loss is detected in a step, or when episodes are cut.
        episodes.cut_off(np.isin(range(4), cut_rows)) if cut_rows else episodes.step(np.zeros((4, 5), dtype=np.int64))
    assert [(playing.env, playing.seed, playing.episode, playing.step) for playing in caught.value.playing] == expected


def test_each_cell_is_counted_once(env: WorkerVectorEnv) -> None:
    # After each demonstration, the cells of its seed are removed from the archive and can be found again.
    visited: set[tuple[int, int]] = set()
    step = env.step

    def recording_step(actions: NDArray[np.int64]) -> tuple[Any, ...]:
        step_result = step(actions)
        visited.update(zip(step_result[4]["state"].tolist(), step_result[4]["cell"].tolist(), strict=True))
        return step_result

    env.step = recording_step  # type: ignore[method-assign]
    demonstrations, reports = run_search(env, SearchSettings(ways=8, steps=20_000, parts=4, imitation=0))
    assert len(demonstrations) == 8
    assert len(visited) / 2 < reports[-1].places <= len(visited)


def curriculum_of(demonstrations: Sequence[SuccessfulEpisode], segments: int, seed: int = 1) -> ReverseCurriculum:
    curriculum = ReverseCurriculum(segments, np.random.default_rng(seed), STEALTH_ACTIONS)
    for demonstration in demonstrations:
        curriculum.add(demonstration)
    return curriculum


def test_starts_move_from_the_end_of_a_demonstration_to_its_start() -> None:
    demonstration = SuccessfulEpisode(1, [[0, 0, 0, 0, 0]] * 80, 1)
    curriculum = curriculum_of([demonstration], 8, 0)

    def draw_segments() -> Counter[int | None]:
        segments = (curriculum.draw().segment for _ in range(1000))
        return Counter(None if segment is None else segment[1] for segment in segments)

    first = draw_segments()
    assert first[7] == max(first.values())
    assert first[None] < 200
    longer = [[1, 0, 0, 0, 0]] * 90
    for segment, times in ((7, 60), (6, 60), (5, 4)):
        for _ in range(times):
            curriculum.record_episode(EpisodeStart(1, demonstration.actions[: 10 * segment], (1, segment)), longer, 1)
    later = draw_segments()
    # Learned segments and segments far from them are drawn less often.
    assert later[5] > 2 * later[4] > 10 * max(later[7], later[6])
    assert later[4] > 1.3 * later[3] > 2 * later[1]
    for _ in range(500):
        curriculum.record_episode(EpisodeStart(2), longer, 1)
    assert draw_segments()[None] > 800


@pytest.mark.parametrize(("from_start", "from_demonstrations"), [(1, 150), (5, 700), (100, 100), (600, 5)])
def test_a_better_agent_begins_more_episodes_at_the_start_of_the_level(
    from_start: int, from_demonstrations: int
) -> None:
    shares = []
    for start_rate in (0.0, 0.5, 1.0):
        curriculum = curriculum_of([SuccessfulEpisode(1, [[0] * 5] * 80, 1)], 8)
        curriculum.lengths[:] = from_start, from_demonstrations
        curriculum.start_rate = start_rate
        shares.append(sum(curriculum.draw().segment is None for _ in range(2000)) / 2000)
    assert shares[0] <= shares[1] + 0.03
    assert shares[1] <= shares[2] + 0.03
    assert 0.95 < shares[2] < 0.99


@pytest.mark.parametrize("length", [30, 90, 900])
def test_a_fifth_of_the_decisions_is_in_episodes_from_the_start_of_the_level(length: int) -> None:
    demonstration = SuccessfulEpisode(1, [[0] * 5] * 80, 1)
    curriculum = curriculum_of([demonstration], 8)
    decisions = Counter[bool]()
    for index in range(6000):
        start = curriculum.draw()
        decision_count = 40 if start.segment else length
        curriculum.record_episode(start, [*start.actions, *[[0] * 5] * decision_count], None)
        if index >= 2000:
            decisions[start.segment is None] += decision_count
    assert 0.15 < decisions[True] / decisions.total() < 0.25


def test_the_last_32_failures_from_the_start_of_the_level_are_kept() -> None:
    curriculum = curriculum_of([SuccessfulEpisode(1, [[0] * 5] * 80, 1)], 8)
    for seed in range(40):
        curriculum.record_episode(EpisodeStart(seed), [[0] * 5] * 9, None, 2)
        curriculum.record_episode(EpisodeStart(seed, segment=(1, 3)), [[0] * 5] * 9, None, 2)
        curriculum.record_episode(EpisodeStart(seed), [[0] * 5] * 9, 1, 3)
        curriculum.record_episode(EpisodeStart(seed), [[0] * 5] * 9, None)
    assert [(failure.seed, failure.state) for failure in curriculum.failures] == [(seed, 2) for seed in range(8, 40)]


def test_a_start_lies_in_its_segment_and_leaves_enough_time() -> None:
    demonstration = SuccessfulEpisode(9, [[0, 0, 0, 0, index % 2] for index in range(160)], 1)
    curriculum = curriculum_of([demonstration], 16)
    for start in (curriculum.draw() for _ in range(300)):
        if start.segment is not None:
            end, segment = start.segment
            assert end == 1
            assert segment * 10 <= len(start.actions) < (segment + 1) * 10
            assert start.actions == demonstration.actions[: len(start.actions)]
            assert start.max_decisions is not None
            assert start.max_decisions >= 160 - len(start.actions)


def test_the_shortest_demonstrations_for_each_end_are_kept() -> None:
    demonstrations = [SuccessfulEpisode(index, [[0] * 5] * (100 + index), index % 2) for index in range(20)]
    demonstrations += [SuccessfulEpisode(0, [[0] * 5] * length, 0) for length in (99, 150)]
    curriculum = curriculum_of(demonstrations, 4)
    curriculum.record_episode(EpisodeStart(77), [[1] * 5] * 50, 0)
    curriculum.record_episode(EpisodeStart(78), [[1] * 5] * 40, None)
    curriculum.record_episode(EpisodeStart(79), [[1] * 5] * 400, 3)
    seeds_by_end = {
        end: [demonstration.seed for demonstration in same_end] for end, same_end in curriculum.demonstrations.items()
    }
    assert seeds_by_end == {0: [77, 0, 2, 4, 6, 8], 1: [1, 3, 5, 7, 9, 11], 3: [79]}
    assert [len(demonstration.actions) for demonstration in curriculum.demonstrations[0]] == [
        50,
        99,
        102,
        104,
        106,
        108,
    ]
    assert {start.segment[0] for start in (curriculum.draw() for _ in range(200)) if start.segment} == {0, 1, 3}


def test_without_demonstrations_episodes_start_at_the_start_of_the_level() -> None:
    curriculum = curriculum_of([], 4)
    assert all(start.segment is None and not start.actions for start in (curriculum.draw() for _ in range(50)))


@pytest.mark.parametrize("count", [0, 3])
def test_the_saved_state_of_the_curriculum_is_complete(count: int) -> None:
    demonstrations = [SuccessfulEpisode(index, [[index, 0, 1, 0, 1]] * (5 + index), index) for index in range(count)]
    curriculum = curriculum_of(demonstrations, 4)
    if count:
        curriculum.record_episode(EpisodeStart(3, (), (2, 2)), [], None)
    curriculum.record_episode(EpisodeStart(3), [[0] * 5] * 200, None)
    for seed in range(count):
        curriculum.record_episode(EpisodeStart(seed), [[seed, 0, 1, 0, 1]] * (3 + seed), None, 1)
    again = curriculum_of([], 4)
    again.load(curriculum.state())
    assert again.failures == curriculum.failures
    assert again.demonstrations == curriculum.demonstrations
    assert {end: rates.tolist() for end, rates in again.rates.items()} == {
        end: rates.tolist() for end, rates in curriculum.rates.items()
    }
    assert again.start_rate == curriculum.start_rate
    assert again.lengths.tolist() == curriculum.lengths.tolist()
    assert [again.draw() for _ in range(9)] == [curriculum.draw() for _ in range(9)]
