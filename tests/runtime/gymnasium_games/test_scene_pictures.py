"""The pictures of episodes of scenes, and the commands that write them."""

from __future__ import annotations

from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image

from tests.runtime.gymnasium_games import vault
from tests.runtime.gymnasium_games.vault_episodes import played
from tltl_runtime.game.episode import trajectory
from tltl_runtime.game.geometry import Box
from tltl_runtime.game.plan import plan_axes
from tltl_runtime.gymnasium_games.gymnasium_game import GAME
from tltl_runtime.gymnasium_games.scene_episode import SceneEpisode
from tltl_runtime.gymnasium_games.scene_pictures import ScenePictures
from tltlc.core.record import replace

PICTURES = ScenePictures()
WALL, PATH, PURPLE, AREA, TILE = (
    (0x47, 0x55, 0x69),
    (0x25, 0x63, 0xEB),
    (0x93, 0x33, 0xEA),
    (0xBA, 0xE6, 0xFD),
    (240, 240, 240),
)


@pytest.fixture(name="episode", scope="module")
def _episode(tmp_path_factory: pytest.TempPathFactory) -> SceneEpisode:
    return played(vault.write(tmp_path_factory.mktemp("vault")))


def colours(png: bytes) -> set[tuple[int, ...]]:
    """The colours of at least a hundred pixels."""
    pixels = np.asarray(Image.open(BytesIO(png)).convert("RGB")).reshape(-1, 3)
    values, counts = np.unique(pixels, axis=0, return_counts=True)
    return set(map(tuple, values[counts >= 100].tolist()))


@pytest.mark.parametrize(("unit", "labels"), [("m", ("x, m", "y, m")), ("", ("x", "y"))])
def test_the_axes_of_a_plan_name_a_unit_that_is_known(unit: str, labels: tuple[str, str]) -> None:
    axes = plan_axes(Figure(), Box((0.0, 0.0, 0.0), (4.0, 3.0, 0.0)), "hall", 1.0, unit)
    assert (axes.get_xlabel(), axes.get_ylabel()) == labels


def test_an_episode_is_drawn_on_the_outline(episode: SceneEpisode) -> None:
    png = PICTURES.episode(episode)
    assert png == PICTURES.episode(episode), "equal episodes give equal pictures"
    assert {WALL, PATH, PURPLE, AREA} <= colours(png)
    assert Image.open(BytesIO(PICTURES.episode(episode, (320, 240)))).size == (320, 240)


def test_trajectories_are_drawn_on_the_outline(episode: SceneEpisode) -> None:
    level = GAME.played_level(episode.level, [episode])
    ways = [way for way in [trajectory(episode)] if way is not None]
    assert WALL in colours(PICTURES.trajectories(level, episode.fspa, ways, "one way"))
    assert WALL not in colours(PICTURES.trajectories(replace(level, outline=None), episode.fspa, ways, "one way"))


def test_a_plan_of_episodes_on_several_maps_says_whose_map_it_shows(episode: SceneEpisode) -> None:
    level = GAME.played_level(episode.level, [episode])
    ways = [way for way in [trajectory(episode)] if way is not None]
    expected = PICTURES.trajectories(level, episode.fspa, ways, "one way, on the map of one of them")
    assert PICTURES.trajectories(replace(level, is_one_of_many=True), episode.fspa, ways, "one way") == expected
    assert PICTURES.trajectories(level, episode.fspa, ways, "one way") != expected


def test_positions_alone_are_enough(episode: SceneEpisode) -> None:
    bare = replace(episode, level=replace(episode.level, outline=None))
    assert PICTURES.draws(bare)
    assert {PATH, PURPLE} <= colours(PICTURES.episode(bare))
    assert not PICTURES.draws(replace(episode, positions=None))


def test_a_damaged_image_is_left_out(episode: SceneEpisode, tmp_path: Path) -> None:
    tiled = played(vault.write(tmp_path), scene="tiled")
    assert tiled.level.outline is not None and tiled.level.outline.image is not None
    assert TILE in colours(PICTURES.episode(tiled))
    image = replace(tiled.level.outline.image, png=tiled.level.outline.image.png[:60])
    damaged = replace(tiled, level=replace(tiled.level, outline=replace(tiled.level.outline, image=image)))
    assert TILE not in colours(PICTURES.episode(damaged))


@pytest.mark.parametrize("stays", [True, False])
def test_a_player_who_does_not_move_can_be_drawn(tmp_path: Path, *, stays: bool) -> None:
    episode = played(vault.write(tmp_path), actions=[0, 0] if stays else [])
    bare = replace(episode, level=replace(episode.level, outline=None))
    assert PICTURES.episode(bare) and PICTURES.episode(episode)
