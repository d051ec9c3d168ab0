"""The example of Doom, a real engine: its scenes, its maps, and its trained agent."""

from __future__ import annotations

import math
import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import gymnasium
import pytest

from tests.interfaces.cli.conftest import ROOT, Outcome, tltlc  # noqa: F401
from tltl_runtime.gymnasium_games.game_file import read_game_file
from tltl_runtime.gymnasium_games.gymnasium_game import GAME
from tltl_runtime.gymnasium_games.scene_env import make_scene_env

# The folder of the package ViZDoom, if it is not among the installed packages.
if folder := os.environ.get("VIZDOOM"):
    sys.path.append(str(Path(folder).parent))
pytest.importorskip("vizdoom")

Run = Callable[..., Outcome]
FOLDER = ROOT / "examples" / "doom"
GAME_FILE = FOLDER / "doom.game.toml"


@pytest.fixture(autouse=True)
def _in_empty_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The engine makes a folder `_vizdoom` in the current one."""
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize(
    ("scene", "variant"),
    [(scene.name, variant) for scene in read_game_file(GAME_FILE).scenes for variant in scene.variants],
)
def test_a_scene_can_be_played_and_says_where_things_are(scene: str, variant: str) -> None:
    env = make_scene_env(GAME_FILE, scene, variant)
    observation, _ = env.reset(seed=3)
    assert env.observation_space.contains(observation)
    assert observation["screen"].std() > 5, "the picture shows something"
    outline = env.get_wrapper_attr("scene_outline")()
    assert outline is not None
    (west, south, _), (east, north, _) = outline.bounds.low, outline.bounds.high
    positions = env.get_wrapper_attr("tltl_positions")()
    assert len(positions) > 1
    assert all(west < x < east and south < y < north for x, y in positions.values())
    env.close()


def test_aimed_shots_kill_the_monster() -> None:
    env = GAME.recorder(GAME.make_env(f"{GAME_FILE}:hunt"), "marksman")
    for seed in range(3):
        play(env, seed, aim)
        assert env.episode.success
        cause = GAME.cause(env.episode)
        assert (cause.kind, cause.by) == ("success", ())
    env.close()


def test_blind_shots_break_the_spec() -> None:
    env = GAME.recorder(GAME.make_env(f"{GAME_FILE}:hunt"), "wastrel")
    play(env, 2, lambda env: button(env, "ATTACK"))
    cause = GAME.cause(env.episode)
    assert cause.kind == "violated"
    assert cause.broke == ("missed > 5",)
    env.close()


def test_a_monster_is_the_cause_of_death() -> None:
    env = GAME.recorder(GAME.make_env(f"{GAME_FILE}:corridor", "nightmare"), "runner")
    play(env, 1, lambda env: 0)
    cause = GAME.cause(env.episode)
    assert cause.kind == "killed"
    name, _, number = cause.by[0].rpartition("_")
    assert name in ("ChaingunGuy", "ShotgunGuy", "Zombieman")
    assert number.isdigit()
    env.close()


def test_the_trained_agent_hunts(tltlc: Run, tmp_path: Path) -> None:  # noqa: F811
    result = tltlc("regress", FOLDER / "suite.toml", "--out", tmp_path / "report", "--workers", "1")
    assert result.status in (0, 1), result.err
    lines = [line.split() for line in result.out.splitlines() if not line.startswith(" ")]
    verdicts = {words[0]: words[1] for words in lines if words[0].startswith("hunt")}
    assert verdicts["hunt:v0"] == "pass"
    assert verdicts["hunt:rockets"] in ("review", "fail")
    assert verdicts["hunt:walking"] == "fail"
    page = (tmp_path / "report" / "report.html").read_text(encoding="utf-8")
    assert "<h3>Map</h3>" in page


def play(env: gymnasium.Env[Any, Any], seed: int, choose: Callable[[Any], int]) -> None:
    """Play an episode."""
    env.reset(seed=seed)
    over = False
    while not over:
        _, _, terminated, truncated, _ = env.step(choose(env))
        over = terminated or truncated


def button(env: Any, name: str) -> int:
    """Return the action that presses a button of Doom."""
    game = env.unwrapped
    place = [own.name for own in game.game.get_available_buttons()].index(name)
    return next(action for action, pressed in enumerate(game.button_map) if sum(pressed) == 1 and pressed[place])


def aim(env: Any) -> int:
    """Step in front of the only monster, and shoot."""
    if env.get_wrapper_attr("tltl_signals")()["off_target"] < math.radians(3):
        return button(env, "ATTACK")
    positions = env.get_wrapper_attr("tltl_positions")()
    (_, y), monster = positions.pop("player"), next(iter(positions.values()))
    return button(env, "MOVE_LEFT" if monster[1] > y else "MOVE_RIGHT")
