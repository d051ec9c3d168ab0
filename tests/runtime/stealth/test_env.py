"""The environments: Gymnasium's own checks, observations, seeds, and the spec's verdict."""

from __future__ import annotations

import subprocess
import sys
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import tltl_runtime  # noqa: F401  (registers the environments)
from tltl_runtime.stealth.env import GameEnv, make_env
from tltl_runtime.stealth.level import MapSensor, Sensors
from tltlc.diagnostics.diagnostic import TltlError

NAMES = ("tltl/Navigation-v0", "tltl/CoverAndHide-v0", "tltl/Branching-v0")


@pytest.mark.parametrize("name", NAMES)
def test_gymnasium_finds_nothing_wrong(name: str) -> None:
    env = gymnasium.make(name, variant="v1")
    check_env(env.unwrapped, skip_render_check=True)
    env.close()
    env = gymnasium.make(name)
    observation, info = env.reset(seed=3)
    assert set(observation) == {"automaton", "progress", "entities", "variables", "map"}
    assert env.observation_space.contains(observation)
    assert list(env.action_space.nvec) == [3, 3, 2, 2, 2]
    assert info["verdict"] == "pending"
    for _ in range(30):
        observation, _, terminated, truncated, info = env.step(env.action_space.sample())
        assert env.observation_space.contains(observation)
        assert observation["automaton"][info["state"]] == 1.0
        if terminated or truncated:
            break
    env.close()


def played(seed: int) -> list[Any]:
    env = make_env("branching")
    rng = np.random.default_rng(5)
    seen = [env.reset(seed=seed)[0]]
    for _ in range(40):
        observation, reward, *_ = env.step([int(rng.integers(size)) for size in (3, 3, 2, 2, 2)])
        seen.append({**observation, "reward": reward})
    env.close()
    return seen


def test_a_seed_reproduces_an_episode() -> None:
    for one, other in zip(played(11), played(11), strict=True):
        assert one.keys() == other.keys()
        assert all(np.array_equal(one[key], other[key]) for key in one)
    assert any(not np.array_equal(a["entities"], b["entities"]) for a, b in zip(played(11), played(12), strict=True))


def test_standing_still_fails_in_the_end() -> None:
    env = make_env("navigation")
    env.reset(seed=0)
    total, done = 0.0, False
    while not done:
        _, reward, terminated, truncated, info = env.step([0, 0, 0, 0, 0])
        total, done = total + reward, terminated or truncated
    assert truncated and not info["success"]
    assert total == pytest.approx(info["progress"] - 1)
    env.close()


def test_the_designer_chooses_what_is_sensed() -> None:
    sensors = Sensors(("exit",), ("time", "distance(s1)", "position.x", "crouching"), MapSensor(("wall",), 1.0, 5))
    env = GameEnv("cover_and_hide", sensors=sensors)
    observation, _ = env.reset(seed=1)
    assert {key: value.shape for key, value in observation.items()} == {
        "entities": (3,),
        "variables": (4,),
        "map": (1, 5, 5),
    }
    x, y, z = env.game.world.player.position
    place = env.level.exits[0].position
    size = env.tltl_params()["level_size"]
    vector = [(place[0] - x) / size, (place[1] - y) / size, (place[2] - z) / size]
    assert observation["entities"] == pytest.approx(vector)
    assert observation["variables"][0] == 0.0
    env.step([0, 0, 0, 1, 0])
    time, near, _, crouching = env.step([0, 0, 0, 1, 0])[0]["variables"]
    assert time == pytest.approx(0.3 / 60.3) and crouching == 1.0
    assert near == pytest.approx(env.tltl_signals()["distance(s1)"] / size)
    env.close()


@pytest.mark.parametrize("sensors", [Sensors(("door",), (), None), Sensors((), ("mood",), None)])
def test_what_the_level_does_not_have_cannot_be_sensed(sensors: Sensors) -> None:
    with pytest.raises(TltlError, match=r"TLT0815: the level `navigation` has no (entity|signal) `(door|mood)`"):
        GameEnv("navigation", sensors=sensors)


def test_gymnasium_takes_plain_mappings_of_sensors() -> None:
    sensors = {"entities": ["exit"], "variables": ["health"], "map": {"cell": 1.0}}
    env = gymnasium.make("tltl/Navigation-v0", sensors=sensors)
    own = env.get_wrapper_attr("level").sensors.map
    shapes = {key: value.shape for key, value in env.reset(seed=1)[0].items()}
    assert shapes["entities"] == (3,) and shapes["variables"] == (1,)
    assert shapes["map"] == (len(own.types), own.extent, own.extent)
    env.close()


def test_importing_registers_and_loads_neither_torch_nor_pybullet() -> None:
    code = "import sys, tltl_runtime; print([m for m in ('torch', 'pybullet', 'matplotlib') if m in sys.modules])"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True).stdout.strip() == "[]"
