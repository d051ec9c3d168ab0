"""The pictures of episodes of the stealth game."""

from __future__ import annotations

from collections.abc import Sequence

from tltl_runtime.game.episode import Trajectory
from tltl_runtime.game.pictures import Pictures
from tltl_runtime.stealth.level import StealthLevel
from tltl_runtime.stealth.recordings.episode import Episode
from tltlc.api import Fspa, Notation


class StealthPictures(Pictures[StealthLevel, Episode]):
    """Draws episodes on plans (maps from above) of their levels, as PNG files.

    Matplotlib is imported only when a picture is drawn.
    """

    def episode(self, episode: Episode, size: tuple[int, int] | None = None, notation: Notation = "english") -> bytes:
        """Return a PNG of the player's path in an episode, on the plan of the level."""
        from tltl_runtime.stealth.rendering.plan import draw_episode

        return draw_episode(episode, size, notation)

    def trajectories(self, level: StealthLevel, fspa: Fspa, trajectories: Sequence[Trajectory], title: str) -> bytes:
        """Return a PNG of the trajectories of many episodes, on the plan of their level."""
        from tltl_runtime.stealth.rendering.trajectories import draw_trajectories

        return draw_trajectories(level, fspa, trajectories, title)
