"""Worker processes give the same steps as environments in this process, bit for bit."""

from __future__ import annotations

import os
import sys
from contextlib import closing
from functools import partial
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium import spaces
from gymnasium.error import ClosedEnvironmentError, ResetNeeded
from gymnasium.vector import AutoresetMode, SyncVectorEnv

import tltl_runtime  # noqa: F401  (registers the environments)
from tests.runtime.vector.envs import Fragile, Preparing
from tests.waiting import until
from tltl_runtime.stealth.env import make_env
from tltl_runtime.vector import WorkerVectorEnv, make_vec
from tltl_runtime.vector.workers import split_evenly

SPEC = """
clock 0.15 s
signal health in [0, 1]
signal position.x: length in [-100 m, 100 m]
predicate well in [-1, 1] = clamp(2 * health - 1, -1, 1)
predicate east in [-1, 1] = clamp((position.x - 90 m) / 190 m, -1, 1)
spec short { limit 23 steps  reach east  keep well }
"""
COUNT = 4
SHARED = ("verdict", "state", "progress", "success")


def equal_values(first: Any, second: Any) -> bool:
    """Whether the values are equal, including the types of arrays."""
    if isinstance(first, dict):
        return (
            isinstance(second, dict)
            and first.keys() == second.keys()
            and all(equal_values(first[k], second[k]) for k in first)
        )
    if isinstance(first, np.ndarray):
        if first.dtype == object:
            return len(first) == len(second) and all(map(equal_values, first, second))
        return first.dtype == second.dtype and np.array_equal(first, second)
    return bool(first == second)


def results_of_steps(env: Any) -> list[Any]:
    """Take 210 steps, with resets by one seed, by none and by a list of seeds; return all results."""
    rng = np.random.default_rng(8)
    rows: list[Any] = []
    for seed, steps in ((7, 90), (None, 60), ([5, 7, 5, 9], 60)):
        rows.append(env.reset(seed=seed))
        for step in range(steps):
            if step % 4 == 0:
                actions = np.stack([rng.integers(size, size=COUNT) for size in (3, 3, 2, 2, 2)], axis=1)
            rows.append(env.step(actions))
    env.close()
    return rows


def in_this_process(autoreset: AutoresetMode) -> list[Any]:
    return results_of_steps(
        SyncVectorEnv([partial(make_env, "cover_and_hide", "v2", SPEC)] * COUNT, autoreset_mode=autoreset)
    )


def without_episode(info: dict[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in info.items() if key not in ("episode", "_episode")}


@pytest.fixture(scope="module")
def expected() -> list[Any]:
    return in_this_process(AutoresetMode.SAME_STEP)


@pytest.mark.parametrize("workers", [1, 2, 3])
def test_any_number_of_workers_gives_the_same_episodes(expected: list[Any], workers: int) -> None:
    env = make_vec("cover_and_hide", "v2", COUNT, workers, spec=SPEC)
    assert env.metadata["autoreset_mode"] is AutoresetMode.SAME_STEP
    assert len(env.worker_pids) == workers
    rows = results_of_steps(env)
    ends, totals, lengths = 0, np.zeros(COUNT), np.zeros(COUNT)
    for ours, theirs in zip(rows, expected, strict=True):
        assert all(
            equal_values(our_part, their_part) for our_part, their_part in zip(ours[:-1], theirs[:-1], strict=True)
        )
        assert all(np.array_equal(ours[-1][key], theirs[-1][key]) for key in SHARED)
        totals = totals + ours[1] if len(ours) == 5 else np.zeros(COUNT)
        lengths = lengths + 1 if len(ours) == 5 else np.zeros(COUNT)
        assert ("final_obs" in ours[-1]) is ("final_obs" in theirs[-1])
        if "final_obs" in ours[-1]:
            final = ours[-1]["final_info"]
            assert equal_values(ours[-1]["final_obs"], theirs[-1]["final_obs"])
            assert equal_values(without_episode(final), theirs[-1]["final_info"])
            over = final["_episode"]
            assert np.allclose(final["episode"]["r"][over], totals[over])
            assert list(final["episode"]["l"][over]) == list(lengths[over])
            totals[over], lengths[over] = 0.0, 0
            ends += 1
    assert ends > 6


def test_with_next_step_an_episode_begins_in_the_step_after_the_end() -> None:
    expected = in_this_process(AutoresetMode.NEXT_STEP)
    env = make_vec("cover_and_hide", "v2", COUNT, 2, spec=SPEC, autoreset="NextStep")
    assert env.metadata["autoreset_mode"] is AutoresetMode.NEXT_STEP
    ends, totals = 0, np.zeros(COUNT)
    for ours, theirs in zip(results_of_steps(env), expected, strict=True):
        assert all(
            equal_values(our_part, their_part) for our_part, their_part in zip(ours[:-1], theirs[:-1], strict=True)
        )
        assert all(np.array_equal(ours[-1][key], theirs[-1][key]) for key in SHARED)
        totals = totals + ours[1] if len(ours) == 5 else np.zeros(COUNT)
        if "episode" in ours[-1]:
            over = ours[-1]["_episode"]
            assert np.allclose(ours[-1]["episode"]["r"][over], totals[over])
            totals[over] = 0.0
            ends += 1
    assert ends > 6


def test_gymnasium_creates_vector_environments_by_id() -> None:
    env = gymnasium.make_vec(
        "tltl/Branching-v0",
        num_envs=3,
        vectorization_mode="vector_entry_point",
        variant="v1",
        workers=2,
        render_mode="rgb_array",
    )
    assert isinstance(env, WorkerVectorEnv)
    observations, infos = env.reset(seed=3)
    assert env.observation_space.contains(observations)
    assert list(infos["verdict"]) == ["pending"] * 3
    observations, rewards, terminated, truncated, infos = env.step(env.action_space.sample())
    assert env.observation_space.contains(observations)
    assert (rewards.shape, terminated.dtype, truncated.dtype) == ((3,), np.bool_, np.bool_)
    assert set(infos) == {name for key in SHARED for name in (key, f"_{key}")}
    frames = env.render()
    assert frames is not None and [frame.ndim for frame in frames] == [3, 3, 3]
    env.close()
    with pytest.raises(ClosedEnvironmentError):
        env.reset()


def test_workers_run_any_environment_with_spaces_of_fixed_size() -> None:
    env = WorkerVectorEnv([lambda: Fragile()] * 3, workers=2)
    observations, infos = env.reset(seed=[1, 2, 1], options={"why": 4})
    assert env.observation_space.contains(observations)
    assert list(infos["options"]["why"]) == [4, 4, 4]
    assert equal_values(observations["pair"][0][0], observations["pair"][0][2])
    with pytest.raises(ValueError, match=r"a batch must have the shape \(3,\), not \(\)"):
        env.step(0)
    for step in range(1, 7):
        observations, rewards, terminated, _, infos = env.step(np.zeros(3, dtype=np.int64))
        assert list(observations["count"]) == list(rewards) == [step] * 3
        assert infos == {} and not terminated.any()
    observations, rewards, terminated, _, infos = env.step(np.zeros(3, dtype=np.int64))
    assert list(rewards) == [7, 7, 7] and terminated.all()
    assert list(observations["count"]) == [0, 0, 0]
    assert [final["count"] for final in infos["final_obs"]] == [7, 7, 7]
    assert list(infos["final_info"]["episode"]["r"]) == [28.0] * 3
    assert env.call("seeds") == ([1, None], [2, None], [1, None])
    env.close()
    env.close()


@pytest.mark.skipif(sys.platform != "linux", reason="other systems spawn workers")
def test_one_process_that_has_loaded_the_game_starts_all_workers() -> None:
    parents = set()
    for _ in range(2):
        with closing(make_vec("cover_and_hide", num_envs=2, workers=2)) as env:
            parents |= {
                int(Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[1]) for pid in env.worker_pids
            }
    (parent,) = parents
    assert parent != os.getpid()


def test_idle_workers_prepare_the_next_reset() -> None:
    env = WorkerVectorEnv([Preparing] * 3, workers=2)
    env.reset(seed=1)
    until(lambda: env.get_attr("left") == (0, 0, 0), "workers that are prepared")
    env.close()


def test_a_first_reset_without_a_seed_draws_seeds() -> None:
    env = WorkerVectorEnv([Fragile] * 2, workers=1)
    with pytest.raises(ResetNeeded):
        env.step(np.zeros(2, dtype=np.int64))
    env.reset()
    env.reset()
    (first, seed_of_second_reset), (second, _) = env.call("seeds")
    assert isinstance(first, int) and isinstance(second, int) and first != second
    assert seed_of_second_reset is None
    env.close()


def test_invalid_arguments_are_rejected() -> None:
    class Talks(Fragile):
        observation_space = spaces.Text(5)  # type: ignore[assignment]

    with pytest.raises(ValueError, match="has no fixed size: workers share Box"):
        WorkerVectorEnv([Talks])
    with pytest.raises(ValueError, match="at least one function"):
        WorkerVectorEnv([])
    with pytest.raises(ValueError, match="not 0"):
        WorkerVectorEnv([Fragile], workers=0)
    with pytest.raises(ValueError, match="the number of names must be 2, not "):
        WorkerVectorEnv([Fragile] * 2, names=["one"])
    with pytest.raises(ValueError, match="not DISABLED"):
        WorkerVectorEnv([Fragile], autoreset=AutoresetMode.DISABLED)
    with pytest.raises(ValueError, match="with autoreset SAME_STEP"):
        WorkerVectorEnv([Fragile], autoreset=AutoresetMode.NEXT_STEP, on_death="replace")


@pytest.mark.parametrize("count, workers, lengths", [(4, 3, [1, 1, 2]), (32, 2, [16, 16]), (5, 1, [5])])
def test_shares_differ_by_at_most_one(count: int, workers: int, lengths: list[int]) -> None:
    shares = list(split_evenly(count, workers))
    assert [share.stop - share.start for share in shares] == lengths
    assert [row for share in shares for row in range(share.start, share.stop)] == list(range(count))
