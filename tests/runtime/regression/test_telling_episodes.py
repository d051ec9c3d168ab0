"""Episodes of a case that are recorded because they show more of its level."""

from __future__ import annotations

from pathlib import Path

from tests.runtime.gymnasium_games import vault
from tests.runtime.gymnasium_games.vault_episodes import played
from tests.runtime.regression.page.samples import explained_of
from tltl_runtime.gymnasium_games.gymnasium_game import GAME
from tltl_runtime.gymnasium_games.scene_episode import SceneEpisode
from tltl_runtime.regression.verdict.play import CaseEpisode, telling_episodes

SHELF = '"shelf": ((0, 5), (4, 6))'


def episodes_of(game: Path, count: int) -> list[SceneEpisode]:
    """Play the vault from the seeds 0, 1, and so on."""
    return [played(game, seed) for seed in range(count)]


def added_to(episodes: list[SceneEpisode], *chosen: int) -> list[int]:
    """Return which episodes are recorded besides the chosen ones."""
    cases = [
        CaseEpisode(explained_of(index, episode), GAME.episode_bytes(episode)) for index, episode in enumerate(episodes)
    ]
    return telling_episodes(GAME.load_level(episodes[0].level.place), cases, chosen)


def test_a_level_that_stays_the_same_needs_no_other_recording(tmp_path: Path) -> None:
    code = vault.CODE.replace("(int(self.np_random.integers(2, 5)), 4)", "(3, 4)")
    episodes = episodes_of(vault.write(tmp_path, vault__py=code), 4)
    assert added_to(episodes, 1) == []


def test_an_entity_that_lies_elsewhere_in_another_episode_is_recorded_there(tmp_path: Path) -> None:
    episodes = episodes_of(vault.write(tmp_path), 6)
    (added,) = added_to(episodes, 0)
    level = GAME.played_level(episodes[0].level, [episodes[0], episodes[added]])
    assert "key" in GAME.landmarks(GAME.played_level(episodes[0].level, episodes[:1]))
    assert GAME.landmarks(level) == GAME.landmarks(GAME.played_level(level, episodes))


def test_a_map_that_changes_is_recorded_twice(tmp_path: Path) -> None:
    assert SHELF in vault.CODE
    code = vault.CODE.replace(SHELF, '"shelf": ((0, 5), (self.key[0], 6))')
    episodes = episodes_of(vault.write(tmp_path, vault__py=code), 6)
    (added,) = added_to(episodes, 0)
    assert episodes[added].level.outline != episodes[0].level.outline
    assert GAME.played_level(episodes[0].level, [episodes[0], episodes[added]]).is_one_of_many
