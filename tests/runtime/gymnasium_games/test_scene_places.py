"""What a scene shows of its places, and what recordings keep of it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.runtime.gymnasium_games import vault
from tests.runtime.gymnasium_games.vault_episodes import played
from tltl_runtime.gymnasium_games.game_check import check_scene
from tltl_runtime.gymnasium_games.game_file import read_game_file
from tltl_runtime.gymnasium_games.gymnasium_game import GAME
from tltl_runtime.gymnasium_games.scene_episode_file import scene_episode_bytes, scene_episode_from_bytes
from tltl_runtime.regression.explain.explain import end_of
from tltl_runtime.regression.explain.explained_episode import explain_episode
from tltl_runtime.regression.explain.places import place_phrase
from tltlc.api import TltlError
from tltlc.core.record import replace


@pytest.fixture(name="game")
def _game(tmp_path: Path) -> Path:
    return vault.write(tmp_path)


@pytest.mark.parametrize("scene", ["plain", "tiled"])
def test_a_recording_keeps_the_outline_and_the_entities(game: Path, scene: str) -> None:
    episode = played(game, scene=scene)
    read = scene_episode_from_bytes(data := scene_episode_bytes(episode), "it")
    assert scene_episode_bytes(read) == data
    assert read.level.outline == episode.level.outline is not None
    assert (read.level.outline.image is not None) == (scene == "tiled")
    assert [region.name for region in read.level.regions] == ["hall", "inner_vault"]
    assert read.entities is not None and episode.entities is not None
    assert read.entities.names == ("key", "guard_1", "exit")
    np.testing.assert_array_equal(read.entities.places, episode.entities.places)
    key = np.isnan(read.entities.places[:, 0, 0]).tolist()
    assert key == [value == 0.0 for value in 1.0 - read.signals[:, 0]], "the key is gone once the player has it"


def test_the_outline_is_that_of_the_episode(game: Path) -> None:
    code = vault.CODE.replace(
        '"bounds": ((0, 0), (WIDTH, HEIGHT))', '"bounds": ((0, 0), (WIDTH + self.key[0], HEIGHT))'
    )
    vault.write(game.parent, vault__py=code)
    widths = {seed: played(game, seed, [0]).level.bounds for seed in range(6)}
    assert len({bounds.high[0] for bounds in widths.values() if bounds is not None}) > 1


def test_a_player_who_is_gone_stays_where_it_was(game: Path) -> None:
    code = vault.CODE.replace(
        '{"player": middle(self.player)', '{"player": middle(None if self.caught else self.player)'
    )
    vault.write(game.parent, vault__py=code)
    episode = played(game, seed=1)
    assert episode.end == "violation" and episode.positions is not None
    assert episode.positions[-1].tolist() == episode.positions[-2].tolist()


def test_entities_that_do_not_move_are_landmarks(game: Path) -> None:
    episode = played(game, seed=1)
    level = GAME.played_level(GAME.load_level(f"{game}:plain"), [episode])
    assert set(GAME.landmarks(level)) == {"key", "exit"}
    assert set(GAME.solids(level)) == {"shelf"}, "two boxes have the name wall"
    assert place_phrase(replace(level, outline=None), (9.0, 3.0, 0.0)).text == "near `exit`"
    end = end_of(level, episode.fspa, explain_episode(GAME.summary(episode), episode))
    assert (end.cause, end.by, end.where.text) == ("killed", ("guard_1",), "in the inner vault")


def test_what_lies_elsewhere_in_another_episode_is_no_landmark(game: Path) -> None:
    level = GAME.load_level(f"{game}:plain")
    episodes = [played(game, seed) for seed in range(4)]
    assert len({episode.entities.still()["key"] for episode in episodes if episode.entities}) > 1
    assert set(GAME.landmarks(GAME.played_level(level, episodes))) == {"exit"}
    assert GAME.played_level(level, []) == level


def test_a_check_reports_a_wrong_outline(game: Path) -> None:
    vault.write(game.parent, vault__py=vault.CODE.replace('"regions"', '"rooms"'))
    with pytest.raises(TltlError, match="TLT0781: the outline that `tltl_outline` returns has the unknown key `rooms`"):
        check_scene(read_game_file(game), "plain", "v0")


def test_an_exception_of_a_method_points_to_its_line(game: Path) -> None:
    vault.write(game.parent, vault__py=vault.CODE.replace('"exit": (9.5, 3.5)}', '"exit": self.way_out}'))
    with pytest.raises(TltlError) as caught:
        played(game, actions=[0])
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.title.startswith("the game's `tltl_positions` raises AttributeError")
    assert diagnostic.labels[0].source.name.endswith("vault.py")
