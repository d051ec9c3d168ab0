"""The pictures of episodes of scenes."""

from __future__ import annotations

from collections.abc import Sequence

from tltl_runtime.game.episode import Trajectory
from tltl_runtime.game.pictures import Pictures
from tltl_runtime.gymnasium_games.scene_episode import SceneEpisode
from tltl_runtime.gymnasium_games.scene_level import SceneLevel
from tltlc.api import Fspa, Notation


class ScenePictures(Pictures[SceneLevel, SceneEpisode]):
    """Draws episodes on the outlines of their scenes. It imports matplotlib only when it draws."""

    def draws(self, episode: SceneEpisode) -> bool:
        """Return whether the recording contains the positions of the player."""
        return episode.positions is not None

    def episode(
        self, episode: SceneEpisode, size: tuple[int, int] | None = None, notation: Notation = "english"
    ) -> bytes:
        """Draw the path of an episode on the outline of its scene."""
        from tltl_runtime.gymnasium_games.scene_plan import draw_scene_episode

        return draw_scene_episode(episode, size, notation)

    def trajectories(self, level: SceneLevel, fspa: Fspa, trajectories: Sequence[Trajectory], title: str) -> bytes:
        """Draw the trajectories of many episodes on the outline of their scene."""
        from tltl_runtime.gymnasium_games.scene_plan import draw_scene_trajectories

        return draw_scene_trajectories(level, fspa, trajectories, title)
