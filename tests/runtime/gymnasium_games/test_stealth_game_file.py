"""The stealth game, played through a game file as any other game."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from tests.interfaces.cli.conftest import ROOT
from tltl_runtime.game.registry import STEALTH, game_named
from tltl_runtime.gymnasium_games.game_check import check_scene
from tltl_runtime.gymnasium_games.game_file import read_game_file
from tltl_runtime.gymnasium_games.gymnasium_game import GAME

pytest.importorskip("pybullet")

GAME_FILE = ROOT / "examples" / "stealth.game.toml"
SCENES = {scene.name: tuple(scene.variants) for scene in read_game_file(GAME_FILE).scenes}


def test_the_scenes_are_the_levels_that_the_package_ships() -> None:
    level_files = game_named(STEALTH).level_files
    assert {name: level_files.variants(name) for name in level_files.names()} == SCENES


@pytest.mark.parametrize(("scene", "variant"), [(scene, variant) for scene in SCENES for variant in SCENES[scene]])
def test_a_scene_is_the_same_play_as_its_level(scene: str, variant: str) -> None:
    """Equal seeds and actions give equal observations, rewards and ends, through either door."""
    through_file = GAME.make_env(f"{GAME_FILE}:{scene}", variant)
    through_level = game_named(STEALTH).make_env(scene, variant)
    assert through_file.task.fspa == through_level.task.fspa
    actions = np.random.default_rng(5)
    observed = through_file.reset(seed=11)[0], through_level.reset(seed=11)[0]
    for _ in range(60):
        assert_equal(*observed)
        action = actions.integers(0, [3, 3, 2, 2, 2])
        (first, *here), (second, *there) = through_file.step(action), through_level.step(action)
        observed = first, second
        assert here[:3] == there[:3]
        assert through_file.sample == through_level.sample
        if here[1] or here[2]:
            break
    through_file.close()
    through_level.close()


def test_a_scene_says_where_things_are() -> None:
    report = check_scene(read_game_file(GAME_FILE), "navigation", "v0")
    assert {"params", "clock", "positions", "outline", "cause", "render"} <= set(report.capabilities)
    env = GAME.recorder(GAME.make_env(f"{GAME_FILE}:navigation"), "tester")
    env.reset(seed=1)
    for _ in range(5):
        env.step(env.action_space.sample())
    level = GAME.played_level(GAME.load_level(f"{GAME_FILE}:navigation"), [env.episode])
    own = game_named(STEALTH).load_level("navigation")
    assert {"s1", "s2", "exit"} <= dict(level.landmarks).keys()
    assert level.bounds == own.bounds
    assert [region.name for region in level.regions] == [region.name for region in own.regions]
    env.close()


def assert_equal(first: dict[str, Any], second: dict[str, Any]) -> None:
    """Check that two observations are equal, bit for bit."""
    assert first.keys() == second.keys()
    for key, value in first.items():
        np.testing.assert_array_equal(value, second[key])
