"""The example of MiniGrid, a game of others: its scenes, its maps, and its trained agent."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.interfaces.cli.conftest import ROOT, Outcome, tltlc  # noqa: F401
from tltl_runtime.gymnasium_games.game_file import read_game_file
from tltl_runtime.gymnasium_games.gymnasium_game import GAME
from tltl_runtime.gymnasium_games.scene_env import make_scene_env

pytest.importorskip("minigrid")

Run = Callable[..., Outcome]
FOLDER = ROOT / "examples" / "minigrid"
GAME_FILE = FOLDER / "minigrid.game.toml"


@pytest.mark.parametrize(
    ("scene", "variant"),
    [
        (scene.name, variant)
        for scene in read_game_file(FOLDER / "minigrid.game.toml").scenes
        for variant in scene.variants
    ],
)
def test_a_scene_can_be_played_and_says_where_things_are(scene: str, variant: str) -> None:
    env = make_scene_env(GAME_FILE, scene, variant)
    observation, _ = env.reset(seed=3)
    assert env.observation_space.contains(observation)
    positions = env.get_wrapper_attr("tltl_positions")()
    assert {"player", "goal"} <= positions.keys()
    (west, south), (east, north) = env.get_wrapper_attr("tltl_outline")()["bounds"]
    assert all(west < x < east and south < y < north for x, y in positions.values())
    assert set(env.sample) == {"has_key", "door_open", "at_goal", "in_lava"}
    env.close()


def test_a_step_into_lava_is_the_cause_of_the_end() -> None:
    env = GAME.recorder(GAME.make_env(f"{GAME_FILE}:lava"), "tester")
    for seed in range(20):
        env.reset(seed=seed)
        over = False
        while not over:
            _, _, terminated, truncated, _ = env.step(env.action_space.sample())
            over = terminated or truncated
        episode = env.episode
        if episode.signals[-1, 1]:
            cause = GAME.cause(episode)
            assert (cause.kind, cause.by, cause.broke) == ("killed", ("lava",), ("in_lava",))
            return
    raise AssertionError("no random walk of twenty ended in lava")


@pytest.mark.slow
def test_the_trained_agent_fetches_the_key(tltlc: Run, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:  # noqa: F811
    monkeypatch.chdir(FOLDER)
    result = tltlc("regress", "suite.toml", "--out", tmp_path, "--workers", "1")
    assert result.status in (0, 1), result.err
    lines = [line.split() for line in result.out.splitlines() if not line.startswith(" ")]
    verdicts = {words[0]: words[1] for words in lines if words[0].startswith("doorkey")}
    assert verdicts["doorkey:v0"] == "pass"
    assert verdicts["doorkey:large"] in ("review", "fail")
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert "<h3>Map</h3>" in page
