"""Recorded episodes of scenes: their files, their causes, and playing them again."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from gymnasium import spaces

from tests.runtime.gymnasium_games import games
from tltl_runtime.game.recording_check import check
from tltl_runtime.game.registry import GYMNASIUM, game_named, game_of, game_of_recording
from tltl_runtime.gymnasium_games.gymnasium_game import GAME
from tltl_runtime.gymnasium_games.scene_episode import SceneEpisode
from tltl_runtime.gymnasium_games.scene_episode_file import (
    read_scene_episode,
    scene_episode_bytes,
    scene_episode_from_bytes,
)
from tltl_runtime.policies.spaces.action_layout import action_layout
from tltlc.api import TltlError
from tltlc.core.record import replace

LEFT, RIGHT = 2, 1
SCENE = "corridor.game.toml:short"
POSITIONS = """
def make(scene, length=5, render_mode=None):
    env = Corridor(length, render_mode)
    env.tltl_positions = lambda: {"player": (float(env.cell), 0.5), "key": (0.0, 0.5)}
    env.tltl_cause = lambda: "the guard" if env.cell == length - 1 and not env.key else None
    return env
"""


@pytest.fixture(name="folder")
def _folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    games.write(tmp_path)
    return tmp_path


def record(actions: list[int], scene: str = SCENE, seed: int = 1, spec: str | None = None) -> SceneEpisode:
    env = GAME.recorder(GAME.make_env(scene, "v0", spec), "tester")
    env.reset(seed=seed)
    for action in actions:
        _, _, terminated, truncated, _ = env.step(action)
        if terminated or truncated:
            break
    env.close()
    return env.episode


FETCH = [LEFT] * 4 + [RIGHT] * 4


@pytest.mark.usefixtures("folder")
def test_a_recording_has_what_was_played() -> None:
    episode = record(FETCH)
    assert (episode.level.name, episode.level.variant, episode.level.game_name) == ("short", "v0", "corridor")
    assert (episode.player, episode.seed, episode.success, episode.end) == ("tester", 1, True, "success")
    count = len(episode.actions)
    assert episode.actions[:, 0].tolist() == FETCH[:count]
    assert episode.times.tolist() == pytest.approx([0.1 * step for step in range(count + 1)])
    assert episode.signals.shape == (count + 1, 2)
    assert episode.signals[-1].tolist() == [1.0, 1.0]
    assert episode.positions is None
    assert check(episode) == ()


@pytest.mark.usefixtures("folder")
@pytest.mark.parametrize("actions", [[], FETCH, [RIGHT] * 3])
def test_files_keep_every_field(tmp_path: Path, actions: list[int]) -> None:
    episode = record(actions)
    data = scene_episode_bytes(episode)
    path = tmp_path / "it.episode.npz"
    path.write_bytes(data)
    read = read_scene_episode(path)
    assert scene_episode_bytes(read) == data
    assert read.level == replace(episode.level, place="", spec=read.level.spec)
    for name in SceneEpisode.__match_args__:
        if name not in ("level", "fspa"):
            np.testing.assert_equal(getattr(read, name), getattr(episode, name))
    assert game_of_recording(path) is game_named(GYMNASIUM)


@pytest.mark.usefixtures("folder")
@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("actions", lambda values: values + 3),
        ("actions", lambda values: values + 0.5),
        ("states", lambda values: values + 40),
        ("time", lambda values: values * 0),
        ("time", lambda values: values + 1),
        ("signals", lambda values: values * np.nan),
        ("atoms", lambda values: values * 4),
        ("rewards", lambda values: values[:-1]),
    ],
)
def test_impossible_values_are_refused(name: str, change: Any) -> None:
    from io import BytesIO

    data = scene_episode_bytes(record(FETCH))
    with np.load(BytesIO(data)) as archive:
        arrays = dict(archive)
    arrays[name] = change(arrays[name])
    changed = BytesIO()
    np.savez(changed, **arrays)
    with pytest.raises(TltlError, match=f"TLT0822: .*{name}"):
        scene_episode_from_bytes(changed.getvalue(), "it")


@pytest.mark.usefixtures("folder")
def test_a_located_episode_is_played_again_and_gives_the_same_signals() -> None:
    episode = scene_episode_from_bytes(scene_episode_bytes(record(FETCH)), "it")
    assert GAME.check_replay(episode) is None
    located = GAME.located(episode, "corridor.game.toml", None)
    assert GAME.check_replay(located) == ()
    changed = located.signals.copy()
    changed[3, 0] = 1 - changed[3, 0]
    (diagnostic,) = GAME.check_replay(replace(located, signals=changed)) or ()
    assert (diagnostic.code, "at step 3" in diagnostic.title) == ("TLT0824", True)
    with pytest.raises(TltlError, match="TLT0800: the recording is of the scene `short`, not of `long`"):
        GAME.located(episode, "corridor.game.toml:long", None)


@pytest.mark.usefixtures("folder")
def test_another_action_space_is_reported() -> None:
    located = GAME.located(record(FETCH), SCENE, None)
    other = replace(located, layout=action_layout(spaces.Discrete(4)))
    with pytest.raises(TltlError, match="TLT0822: the recording has other actions than the scene `short` has now"):
        GAME.check_replay(other)


@pytest.mark.usefixtures("folder")
def test_the_cause_says_what_remained_or_what_broke(folder: Path) -> None:
    assert GAME.cause(record(FETCH)).text.startswith("success after 0.")
    stopped = GAME.cause(record([0]))
    assert (stopped.kind, stopped.place) == ("stopped", None)
    assert stopped.text == "stopped after 0.10 s, remaining: Reach has_key, then door_open"
    late = GAME.cause(record([0] * 300))
    assert (late.kind, late.text.partition(",")[0]) == ("limit", "limit after 200 steps")
    spec = folder / "keep.tltl"
    spec.write_text("clock 10 Hz\nsignal has_key: bool\nspec without { avoid has_key limit 20 s }\n")
    broken = GAME.cause(record([LEFT] * 5, spec=str(spec)))
    assert (broken.kind, broken.by, broken.broke) == ("violated", ("has_key",), ("has_key",))
    assert broken.text.endswith("has_key holds")


@pytest.mark.usefixtures("folder")
def test_positions_and_the_killer_are_recorded(folder: Path) -> None:
    games.write(folder, corridor__py=games.GRID + POSITIONS)
    spec = folder / "keep.tltl"
    spec.write_text("clock 10 Hz\nsignal cell in [0, 100]\nspec near_start { keep cell < 2.5 limit 20 s }\n")
    episode = record([RIGHT] * 4, spec=str(spec))
    assert episode.positions is not None
    assert episode.positions[-1].tolist() == [3.0, 0.5, 0.0]
    cause = GAME.cause(scene_episode_from_bytes(scene_episode_bytes(episode), "it"))
    assert (cause.kind, cause.by, cause.broke, cause.place) == ("killed", ("the guard",), ("cell < 2.5",), (3, 0.5, 0))


@pytest.mark.parametrize("positions", ["{}", "{'player': (1.0,)}", "{'player': (1.0, float('nan'))}"])
def test_a_position_of_the_player_is_needed(folder: Path, positions: str) -> None:
    code = POSITIONS.replace('{"player": (float(env.cell), 0.5), "key": (0.0, 0.5)}', positions)
    games.write(folder, corridor__py=games.GRID + code)
    with pytest.raises(TltlError, match="TLT0781: the game's `tltl_positions` gives no position of `player`"):
        record([RIGHT])


@pytest.mark.parametrize(
    ("level", "name"),
    [("corridor.game.toml", "gymnasium"), (SCENE, "gymnasium"), ("vault.toml", "stealth"), ("navigation", "stealth")],
)
def test_a_level_knows_its_game(level: str, name: str) -> None:
    assert game_of(level) is game_named(name)


def test_overlays_are_for_levels_of_the_stealth_game(folder: Path) -> None:
    with pytest.raises(TltlError, match="TLT0800: `wider` cannot be added"):
        GAME.load_level(SCENE, "v0+wider")
    assert not GAME.level_files.overlays(SCENE)
    names = {path.name for path in GAME.level_files.dependencies(SCENE, replace_variant())}
    assert {"corridor.game.toml", "corridor.py", "corridor.tltl", "tltl.toml"} <= names
    assert folder


def replace_variant() -> Any:
    from tltl_runtime.game.level_name import Variant

    return Variant("v0")


def test_an_episode_that_no_longer_ends_is_another_one(folder: Path) -> None:
    located = GAME.located(record(FETCH), SCENE, None)
    (diagnostic,) = GAME.check_replay(replace(located, actions=located.actions, end="stopped")) or ()
    assert diagnostic.code == "TLT0824"
    assert folder


def test_deleted_files_are_dependencies(folder: Path) -> None:
    def names() -> set[str]:
        return {path.resolve().name for path in GAME.level_files.dependencies(SCENE, replace_variant())}

    games.write(folder, corridor__py=games.GRID + "\n\ndef late():\n    import helper\n")
    assert {"helper.py", "corridor.py", "corridor.tltl"} <= names()
    (folder / "corridor.tltl").unlink()
    assert folder.name in names()


def test_a_relative_import_outside_a_package_is_passed_over(folder: Path) -> None:
    fallback = "\n\ntry:\n    from . import helper\nexcept ImportError:\n    helper = None\n"
    games.write(folder, corridor__py=games.GRID + fallback)
    assert GAME.load_level(SCENE).name == "short"


def test_a_cause_that_raises_is_reported(folder: Path) -> None:
    code = POSITIONS.replace('"the guard" if env.cell == length - 1 and not env.key else None', "1 / 0")
    games.write(folder, corridor__py=games.GRID + code)
    with pytest.raises(TltlError, match="TLT0781: the game's `tltl_cause` raises ZeroDivisionError"):
        record(FETCH)


def test_games_that_register_the_same_id_do_not_mix(folder: Path) -> None:
    lengths = {"one": 3, "two": 5}
    for name, length in lengths.items():
        code = f"""\
import gymnasium
from gymnasium import spaces


class Hall(gymnasium.Env):
    observation_space = action_space = spaces.Discrete(2)
    length = {length}

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        return 0, {{}}

    def step(self, action):
        return 0, 0.0, False, False, {{}}

    def tltl_signals(self):
        return {{"has_key": False, "door_open": False}}


gymnasium.register("Hall-v0", entry_point=Hall)
"""
        (folder / name).mkdir()
        (folder / name / f"{name}_hall.py").write_text(code)
        (folder / name / "hall.game.toml").write_text(
            f'[game]\ngymnasium = "Hall-v0"\nimport = ["{name}_hall"]\nclock = "10 Hz"\n'
        )
    for name in ("one", "two", "one"):
        env = GAME.make_env(f"{name}/hall.game.toml", spec=str(folder / "corridor.tltl"))
        assert env.unwrapped.length == lengths[name]  # type: ignore[attr-defined]
        env.close()
