"""The map of a scene as SVG, and its episodes as data for the page."""

from __future__ import annotations

import base64
import json
from xml.etree import ElementTree

import numpy as np
import pytest

from tests.runtime.game.test_packing import unstepped
from tests.runtime.gymnasium_games import vault
from tests.runtime.gymnasium_games.vault_episodes import played
from tltl_runtime.game.mentions import Mentions
from tltl_runtime.gymnasium_games.gymnasium_game import GAME
from tltl_runtime.gymnasium_games.scene_episode import SceneEpisode
from tltl_runtime.gymnasium_games.scene_level import SceneLevel
from tltl_runtime.gymnasium_games.scene_maps import SceneMaps
from tltlc.core.record import replace

MAPS = SceneMaps()
CM = 200
"""Centimetres on the map for each cell of the vault, whose 10 cells are 20 metres on the map."""


@pytest.fixture(name="episode", scope="module")
def _episode(tmp_path_factory: pytest.TempPathFactory) -> SceneEpisode:
    return played(vault.write(tmp_path_factory.mktemp("vault")), scene="tiled")


@pytest.fixture(name="level")
def _level(episode: SceneEpisode) -> SceneLevel:
    return GAME.played_level(episode.level, [episode])


def classes(root: ElementTree.Element, kind: str) -> list[ElementTree.Element]:
    return [element for element in root.iter() if kind in element.get("class", "").split()]


def names(root: ElementTree.Element) -> set[str]:
    return {" ".join(line.text or "" for line in element.iter("tspan")) for element in root.iter("text")}


def test_a_map_shows_the_outline_and_the_landmarks(level: SceneLevel) -> None:
    root = ElementTree.fromstring(MAPS.picture(level))
    assert [element.findtext("title") for element in classes(root, "wall")] == ["wall", "wall", "shelf"]
    wall = classes(root, "wall")[0]
    assert [wall.get(key) for key in ("x", "y", "width", "height")] == ["1000", "800", "200", "400"]
    (carpet,) = classes(root, "area")
    assert carpet.get("points") == "1300,1100 1900,1100 1600,700"
    assert len(classes(root, "region")) == 2
    assert {element.findtext("title") for element in classes(root, "landmark")} == {"key", "exit"}
    assert names(root) == {"key", "exit", "hall", "inner vault"}
    (image,) = root.iter("image")
    data = base64.b64decode((image.get("href") or "").removeprefix("data:image/png;base64,"))
    assert level.outline is not None and level.outline.image is not None and data == level.outline.image.png
    assert [image.get(key) for key in ("x", "y", "width", "height")] == ["0", "0", "2000", "1200"]
    layers = [element.get("class") for element in root if element.tag == "g"]
    assert layers == ["heat", "trajectories", "ends", "names", "live"]


def test_what_is_mentioned_is_highlighted(level: SceneLevel) -> None:
    mentions = MAPS.mentions(level, "Opens `shelf` and the inner vault, not carpet; `wall` too.")
    assert mentions == Mentions(("wall", "shelf"), ("inner_vault",))
    root = ElementTree.fromstring(MAPS.picture(level, mentions))
    assert names(root) == {"key", "exit", "hall", "inner vault", "shelf"}, "two boxes are named wall"
    assert len(classes(root, "mentioned")) == 3 + 2
    assert "mentioned in a reason" in MAPS.key(level, mentions)
    assert "mentioned in a reason" not in MAPS.key(level)


def test_names_cannot_inject_markup(level: SceneLevel) -> None:
    assert level.outline is not None
    evil = "</svg><script>alert(1)</script>\"'"
    boxes = tuple(replace(item, name=evil) for item in level.outline.boxes[:1])
    changed = replace(level, outline=replace(level.outline, boxes=boxes), landmarks=((evil, (1.0, 1.0, 0.0)),))
    root = ElementTree.fromstring(MAPS.picture(changed))
    assert not [*root.iter("script")]


@pytest.mark.parametrize("size", [0.5, 10.0, 4000.0])
def test_maps_of_large_and_small_levels_have_the_same_size(level: SceneLevel, size: float) -> None:
    assert level.outline is not None
    bounds = level.outline.bounds
    scaled = replace(bounds, low=(0.0, 0.0, 0.0), high=(size, 0.6 * size, 1.0))
    outline = replace(level.outline, bounds=scaled, boxes=(), polygons=(), regions=(), image=None)
    root = ElementTree.fromstring(MAPS.picture(replace(level, outline=outline, landmarks=())))
    assert root.get("viewBox") == "-30 -30 2060 1260"


def test_an_episode_has_every_row(episode: SceneEpisode) -> None:
    data = json.loads(json.dumps(MAPS.episode_data(episode.level, 4, episode)))
    count = len(episode.actions) + 1
    assert (data["index"], len(unstepped(data["time"]))) == (4, count)
    assert episode.positions is not None and episode.entities is not None
    assert unstepped(data["player"]["x"]) == (CM * episode.positions[:, 0]).tolist()
    assert unstepped(data["player"]["y"]) == (1200 - CM * episode.positions[:, 1]).tolist()
    assert [entity["name"] for entity in data["entities"]] == ["key", "guard_1", "exit"]
    for column, entity in enumerate(data["entities"]):
        places = episode.entities.places[:, column]
        there = [bool(value) for value, repeated in entity["there"] for _ in range(repeated)]
        assert there == (~np.isnan(places[:, 0])).tolist()
        xs = np.array(unstepped(entity["x"]))
        assert xs.shape == (count,)
        np.testing.assert_array_equal(xs[there], CM * places[there, 0])


def test_an_entity_that_appears_late_has_a_place_before(episode: SceneEpisode) -> None:
    assert episode.entities is not None
    places = episode.entities.places.copy()
    places[:3, 1] = np.nan
    late = replace(episode, entities=replace(episode.entities, places=places))
    (guard,) = [entity for entity in MAPS.episode_data(late.level, 0, late)["entities"] if entity["name"] == "guard_1"]
    ys = unstepped(guard["y"])
    assert ys[0] == ys[1] == ys[2] == ys[3]
    places[:, 1] = np.nan
    gone = replace(episode, entities=replace(episode.entities, places=places))
    assert "guard_1" not in {entity["name"] for entity in MAPS.episode_data(gone.level, 0, gone)["entities"]}
