"""The environments: the checks of Gymnasium, observations, seeds, and the verdict of the spec."""

from __future__ import annotations

import copy
import gc
import pickle
import subprocess
import sys
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.envs.registration import EnvSpec
from gymnasium.error import ClosedEnvironmentError
from gymnasium.utils.env_checker import check_env

import tltl_runtime  # noqa: F401  (registers the environments)
from tltl_runtime import load_task
from tltl_runtime.game.level import default_spec
from tltl_runtime.stealth.env import GameEnv, make_env
from tltl_runtime.stealth.level import MapSensor, Sensors
from tltl_runtime.stealth.levels.file import load_level
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import TltlError

NAMES = ("tltl/Navigation-v0", "tltl/CoverAndHide-v0", "tltl/Branching-v0")


@pytest.mark.parametrize("name", NAMES)
def test_the_checker_of_gymnasium_finds_no_fault(name: str) -> None:
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


def play(seed: int) -> list[Any]:
    env = make_env("branching")
    rng = np.random.default_rng(5)
    observations = [env.reset(seed=seed)[0]]
    for _ in range(40):
        observation, reward, *_ = env.step([int(rng.integers(size)) for size in (3, 3, 2, 2, 2)])
        observations.append({**observation, "reward": reward})
    env.close()
    return observations


def test_a_seed_reproduces_an_episode() -> None:
    for first, second in zip(play(11), play(11), strict=True):
        assert first.keys() == second.keys()
        assert all(np.array_equal(first[key], second[key]) for key in first)
    assert any(not np.array_equal(a["entities"], b["entities"]) for a, b in zip(play(11), play(12), strict=True))


def test_an_episode_of_standing_still_fails() -> None:
    env = make_env("navigation")
    env.reset(seed=0)
    total, done = 0.0, False
    while not done:
        _, reward, terminated, truncated, info = env.step([0, 0, 0, 0, 0])
        total, done = total + reward, terminated or truncated
    assert truncated and not info["success"]
    assert total == pytest.approx(info["progress"] - 1)
    env.close()


def test_the_sensors_can_be_chosen() -> None:
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
    time, distance, _, crouching = env.step([0, 0, 0, 1, 0])[0]["variables"]
    assert time == pytest.approx(0.3 / 60.3) and crouching == 1.0
    assert distance == pytest.approx(env.tltl_signals()["distance(s1)"] / size)
    env.close()


def test_later_steps_do_not_change_an_observation() -> None:
    env = GameEnv("cover_and_hide")
    first, _ = env.reset(seed=1)
    copies = {key: value.copy() for key, value in first.items()}
    for _ in range(20):
        second, *_ = env.step((1, 1, 0, 0, 1))
    assert all(np.array_equal(first[key], copies[key]) for key in copies)
    assert not np.array_equal(first["entities"], second["entities"])
    env.close()


@pytest.mark.parametrize("sensors", [Sensors(("door",), (), None), Sensors((), ("mood",), None)])
def test_unknown_entities_and_signals_cannot_be_sensed(sensors: Sensors) -> None:
    with pytest.raises(TltlError, match=r"TLT0815: the level `navigation` has no (entity|signal) `(door|mood)`"):
        GameEnv("navigation", sensors=sensors)


def test_gymnasium_accepts_a_mapping_of_sensors() -> None:
    sensors = {"entities": ["exit"], "variables": ["health"], "map": {"cell": 1.0}}
    env = gymnasium.make("tltl/Navigation-v0", sensors=sensors)
    map_sensor = env.get_wrapper_attr("level").sensors.map
    shapes = {key: value.shape for key, value in env.reset(seed=1)[0].items()}
    assert shapes["entities"] == (3,) and shapes["variables"] == (1,)
    assert shapes["map"] == (len(map_sensor.types), map_sensor.extent, map_sensor.extent)
    env.close()


def test_importing_registers_and_loads_neither_torch_nor_pybullet() -> None:
    code = "import sys, tltl_runtime; print([m for m in ('torch', 'pybullet', 'matplotlib') if m in sys.modules])"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True).stdout.strip() == "[]"


@pytest.mark.parametrize(
    "action", [[0] * 4, [0] * 6, [3, 0, 0, 0, 0], [-1, 0, 0, 0, 0], [0, 0, 0, 0, 2], [0.0] * 5, [np.nan] * 5, "jump", 0]
)
def test_invalid_actions_are_rejected(action: Any) -> None:
    env = make_env("navigation")
    env.reset(seed=1)
    with pytest.raises(ValueError, match=r"five whole numbers of MultiDiscrete\(\[3 3 2 2 2\]\): x, y, jump, crouch"):
        env.step(action)
    assert env.unwrapped.game.steps == 0  # type: ignore[attr-defined]
    env.close()


def test_a_closed_environment_raises_an_error() -> None:
    env = make_env("navigation")
    env.reset(seed=1)
    env.close()
    env.close()
    for call in (lambda: env.step([0] * 5), env.reset, env.render):
        with pytest.raises(ClosedEnvironmentError, match="this environment is closed: make another one"):
            call()


def test_a_running_game_cannot_be_copied() -> None:
    env = make_env("navigation")
    env.reset(seed=1)
    for copy_env in (copy.deepcopy, pickle.dumps):
        with pytest.raises(TypeError, match="neither copied nor pickled: make another environment, and reset it"):
            copy_env(env)  # type: ignore[operator]
    env.step([0] * 5)
    env.close()


def test_an_environment_that_is_not_closed_frees_its_physics() -> None:
    env = make_env("navigation")
    env.reset(seed=1)
    finalizer = env.unwrapped.game.world._disconnect  # type: ignore[attr-defined]
    assert finalizer.alive
    del env
    gc.collect()
    assert not finalizer.alive


def test_gymnasium_recreates_an_environment_from_json() -> None:
    env = gymnasium.make("tltl/Navigation-v0", variant="v1", params={"level_size": 21.0})
    assert env.spec is not None
    restored = gymnasium.make(EnvSpec.from_json(env.spec.to_json()))
    assert restored.spec == env.spec
    for made_env in (env, restored):
        assert made_env.get_wrapper_attr("level").variant == "v1"
        assert made_env.get_wrapper_attr("task").params == {"level_size": 21.0}
    assert np.array_equal(env.reset(seed=5)[0]["entities"], restored.reset(seed=5)[0]["entities"])
    env.close()
    restored.close()


def test_a_missing_entity_is_reported_at_its_place_in_the_spec(tmp_path: Path) -> None:
    plan = tmp_path / "plan.tltl"
    plan.write_text("import stealth\nentity s9\nspec plan = F near(s9)\n", encoding="utf-8")
    with pytest.raises(TltlError) as caught:
        make_env("navigation", spec=plan)
    (diagnostic,) = caught.value.diagnostics
    assert (diagnostic.code, diagnostic.title) == ("TLT0810", "the level `navigation` has no entity `s9`")
    label = diagnostic.labels[0]
    assert (label.source.name, label.source.slice(label.span)) == (str(plan), "s9")
    for spec in (plan.read_text(encoding="utf-8"), load_task(plan).fspa):
        with pytest.raises(TltlError, match="TLT0810"):
            make_env("navigation", spec=spec)


def test_a_level_without_a_spec_needs_one() -> None:
    with pytest.raises(TltlError, match="TLT0721: the level `bare` does not name a spec"):
        default_spec(replace(load_level("navigation"), name="bare", spec=None))


@pytest.mark.parametrize(
    ("options", "text"),
    [
        ({"level": 3}, "the level must be a text or a path, not 3"),
        ({"variant": 1}, "the variant must be a text, not 1"),
        ({"variant": None}, "the variant must be a text, not None"),
        ({"variant": Path("v0")}, "the variant must be a text, not "),
        ({"sensors": ["exit"]}, r"sensors must be a mapping, e\.g\. {'entities': \['exit'\]}, not \['exit'\]"),
        ({"reward": "sparse"}, r"RewardOptions\(mode=\"sparse\"\), not 'sparse'"),
        ({"params": [1.0]}, "params must map names to numbers"),
        ({"spec": ()}, "a spec must be a path, a text or an automaton, not"),
    ],
)
def test_options_of_the_wrong_type_are_rejected(options: dict[str, Any], text: str) -> None:
    with pytest.raises(TypeError, match=text):
        make_env(**{"level": "navigation", **options})


def test_an_entity_cannot_be_sensed_twice() -> None:
    with pytest.raises(TltlError, match="TLT0815: the sensors name `exit` twice"):
        make_env("navigation", sensors={"entities": ["exit", "exit"]})
