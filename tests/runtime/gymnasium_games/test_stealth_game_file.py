"""The stealth game, wrapped and played through a game file as any other game."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("pybullet")

from tests.runtime.gymnasium_games import wrapped_stealth
from tltl_runtime.game.level import default_spec
from tltl_runtime.game.registry import STEALTH, game_named
from tltl_runtime.gymnasium_games.game_check import check_scene
from tltl_runtime.gymnasium_games.game_file import read_game_file
from tltl_runtime.gymnasium_games.gymnasium_game import GAME

STEALTH_GAME = game_named(STEALTH)
TWO_STAGES = """\
import spatial
entity s1
entity s2
spec two_stages { limit 20 steps
  reach near(s1) then near(s2)
}
"""
"""The expert reaches the first switch after five steps, and is then on its way to the second."""


@pytest.fixture(name="game_file", scope="module")
def _game_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("wrapped")
    shutil.copy(wrapped_stealth.__file__, folder)
    path = folder / "wrapped.game.toml"
    path.write_text(wrapped_stealth.GAME, encoding="utf-8")
    return path


def make_env(game_file: Path, scene: str, spec: str = "") -> Any:
    return GAME.make_env(f"{game_file}:{scene}", "v0", spec or default_spec(STEALTH_GAME.load_level(scene)))


@pytest.mark.parametrize("scene", ["navigation", "cover_and_hide"])
def test_a_scene_is_the_same_play_as_its_level(game_file: Path, scene: str) -> None:
    """Equal seeds and actions give equal observations, rewards and ends, through either door."""
    through_file, through_level = make_env(game_file, scene), STEALTH_GAME.make_env(scene)
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


def test_the_expert_of_a_scene_plays_as_that_of_its_level(game_file: Path) -> None:
    """The task and the observation tell the expert as much as the environment of the level does."""
    through_file = GAME.recorder(make_env(game_file, "navigation", TWO_STAGES), "expert")
    through_level = STEALTH_GAME.recorder(STEALTH_GAME.make_env("navigation", spec=TWO_STAGES), "expert")
    ours = GAME.expert_episodes(through_file, range(2))
    for episode, own in zip(ours, STEALTH_GAME.expert_episodes(through_level, range(2)), strict=True):
        assert 1 in episode.states
        np.testing.assert_array_equal(episode.actions, own.actions)
        np.testing.assert_array_equal(episode.rewards, own.rewards)
    through_file.close()
    through_level.close()


def test_a_scene_says_where_things_are(game_file: Path) -> None:
    report = check_scene(read_game_file(game_file), "navigation", "v0")
    assert {"params", "clock", "positions", "outline", "cause", "expert", "render"} <= set(report.capabilities)
    env = GAME.recorder(make_env(game_file, "navigation"), "tester")
    env.reset(seed=1)
    for _ in range(5):
        env.step(env.action_space.sample())
    level = GAME.played_level(GAME.load_level(f"{game_file}:navigation"), [env.episode])
    own = STEALTH_GAME.load_level("navigation")
    assert {"s1", "s2", "exit"} <= dict(level.landmarks).keys()
    assert level.bounds == own.bounds
    assert [region.name for region in level.regions] == [region.name for region in own.regions]
    env.close()


def assert_equal(first: dict[str, Any], second: dict[str, Any]) -> None:
    """Check that two observations are equal, bit for bit."""
    assert first.keys() == second.keys()
    for key, value in first.items():
        np.testing.assert_array_equal(value, second[key])
