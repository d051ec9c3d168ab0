"""Recordings contain what was played, and recording does not change the game."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest

import tltl_runtime  # noqa: F401  (registers the environments)
from tltl_runtime.stealth.env import GameEnv, make_env
from tltl_runtime.stealth.episode_recorder import RecordEpisode
from tltlc.diagnostics.diagnostic import TltlError

NOTHING = [0, 0, 0, 0, 0]
SOON = "signal health: ratio  spec soon { limit 4 steps  reach health < 50 % }"
STAY = "signal health: ratio  spec stay { limit 4 steps  keep health > 50 % }"
FALL = "signal time: time in [0 s, 60 s]  spec fall { limit 40 steps  keep time < 0.4 s }"
CLIMB = "signal time: time in [0 s, 60 s]  spec climb { limit 40 steps  reach time > 0.4 s }"


def actions(count: int, seed: int = 5) -> list[list[int]]:
    rng = np.random.default_rng(seed)
    return [[int(rng.integers(size)) for size in (3, 3, 2, 2, 2)] for _ in range(count)]


@pytest.fixture(name="recorder")
def _recorder() -> Iterator[RecordEpisode]:
    env = RecordEpisode(make_env("cover_and_hide"), player="dice")
    yield env
    env.close()


def test_a_recording_contains_the_steps_that_were_played(recorder: RecordEpisode) -> None:
    _, info = recorder.reset(seed=7)
    infos, rewards, played_actions = [info], [], actions(30)
    for action in played_actions:
        _, reward, _, _, info = recorder.step(action)
        infos.append(info)
        rewards.append(reward)
    episode = recorder.episode
    game = recorder.unwrapped.game  # type: ignore[attr-defined]
    names = [signal.name for signal in episode.fspa.signals]
    assert episode.level.name == "cover_and_hide" and episode.player == "dice" and episode.seed == game.seed
    assert episode.actions.tolist() == played_actions and episode.rewards.tolist() == rewards
    assert episode.states.tolist() == [info["state"] for info in infos]
    assert episode.progress.tolist() == [info["progress"] for info in infos]
    assert episode.atoms.tolist() == [list(info["atoms"].values()) for info in infos[1:]]
    assert episode.signals.shape == (31, len(names)) and len(episode.snapshots) == 31
    assert episode.signals[-1].tolist() == [game.signals()[name] for name in names]
    assert episode.signals[:, names.index("health")].tolist() == [snapshot.health for snapshot in episode.snapshots]
    assert episode.snapshots[-1] == game.snapshot() and episode.snapshots[0].time == 0.0
    assert (episode.end, episode.success, episode.verdict) == ("stopped", False, infos[-1]["verdict"])
    assert episode.params == {"level_size": pytest.approx(recorder.unwrapped.tltl_params()["level_size"])}  # type: ignore[attr-defined]
    assert {"python", "tltlc", "pybullet", "numpy"} == set(episode.versions)


def test_recording_does_not_change_the_game() -> None:
    plain, recorded = make_env("branching", "v1"), RecordEpisode(make_env("branching", "v1"))
    for seed in (3, None):
        results: list[list[Any]] = []
        for env in (plain, recorded):
            env_results: list[Any] = [env.reset(seed=seed)]
            env_results += [env.step(action) for action in actions(40)]
            results.append(env_results)
        for first, second in zip(*results, strict=True):
            assert all(np.array_equal(first[0][key], second[0][key]) for key in first[0] | second[0])
            assert first[1:] == second[1:]
    plain.close()
    recorded.close()


def test_an_episode_is_a_copy_and_a_reset_starts_a_new_one(recorder: RecordEpisode) -> None:
    with pytest.raises(RuntimeError, match="first reset"):
        _ = recorder.episode
    with pytest.raises(RuntimeError, match="first reset"):
        recorder.step(NOTHING)
    recorder.reset()
    first = recorder.episode
    assert len(first.actions) == 0 and first.verdict == "pending" and first.states.tolist() == [0]
    assert first.atoms.shape == (0, len(first.fspa.atoms)) and first.actions.shape == (0, 5)
    recorder.step(NOTHING)
    assert len(first.snapshots) == 1 and len(recorder.episode.snapshots) == 2
    recorder.reset()
    second = recorder.episode
    assert len(second.snapshots) == 1 and second.seed != first.seed


@pytest.mark.parametrize(
    ("spec", "end", "success", "steps"),
    [
        (SOON, "limit", False, 4),
        (STAY, "success", True, 4),
        (FALL, "violation", False, 3),
        (CLIMB, "success", True, 3),
    ],
)
def test_a_recording_says_how_the_episode_ended(spec: str, end: str, success: bool, steps: int) -> None:
    env = RecordEpisode(make_env("navigation", spec=spec))
    env.reset(seed=1)
    for _ in range(6):  # steps after the end are not recorded
        env.step(NOTHING)
    episode = env.episode
    env.close()
    assert (episode.end, episode.success, len(episode.actions)) == (end, success, steps)


def test_a_time_limit_of_gymnasium_ends_a_recording_as_stopped() -> None:
    env = RecordEpisode(gymnasium.make("tltl/Navigation-v0", max_episode_steps=3))
    env.reset(seed=1)
    ends = [env.step(NOTHING)[3] for _ in range(3)]
    assert ends == [False, False, True]
    assert env.episode.end == "stopped"
    env.close()


def test_other_environments_cannot_be_recorded() -> None:
    with pytest.raises(TypeError, match="only the stealth game can be recorded, not CartPoleEnv"):
        RecordEpisode(gymnasium.make("CartPole-v1"))
    game = GameEnv("navigation")
    with pytest.raises(TypeError, match="wrap the game in TltlEnv first"):
        RecordEpisode(game)
    game.close()


def test_an_invalid_action_is_not_recorded(recorder: RecordEpisode) -> None:
    recorder.reset()
    with pytest.raises(ValueError, match="is not an action: expected five whole numbers"):
        recorder.step([3, 0, 0, 0, 0])
    assert len(recorder.episode.actions) == 0


def test_the_action_that_reaches_the_game_is_recorded() -> None:
    east = gymnasium.wrappers.TransformAction(make_env("navigation"), lambda _: [1, 0, 0, 0, 0], None)
    env = RecordEpisode(east)
    env.reset(seed=1)
    env.step(NOTHING)
    assert env.episode.actions.tolist() == [[1, 0, 0, 0, 0]] and env.episode.player == "unknown"
    env.close()


def test_an_unusable_folder_is_reported_at_once(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    env = make_env("navigation")
    for folder in ("/proc/x", tmp_path / "file"):
        with pytest.raises(TltlError, match="TLT0005"):
            RecordEpisode(env, folder=folder)
    env.close()
