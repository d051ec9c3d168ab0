"""Pictures of a game's episodes."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import Generic

from tltl_runtime.game.episode import Trajectory
from tltl_runtime.game.level_files import LevelT
from tltl_runtime.game.recorder import EpisodeT
from tltlc.api import Fspa, Notation


class Pictures(ABC, Generic[LevelT, EpisodeT]):
    """Draws episodes of a game from above, as PNG files."""

    def draws(self, episode: EpisodeT) -> bool:
        """Return whether an episode can be drawn; by default always."""
        del episode
        return True

    @abstractmethod
    def episode(self, episode: EpisodeT, size: tuple[int, int] | None = None, notation: Notation = "english") -> bytes:
        """Draw the path of an episode, and say what remained to be satisfied on the way.

        ``size`` is the width and the height in pixels; by default, it fits the level. ``notation`` is the
        notation of formulas.
        """

    @abstractmethod
    def trajectories(self, level: LevelT, fspa: Fspa, trajectories: Sequence[Trajectory], title: str) -> bytes:
        """Draw the trajectories of many episodes of a level; ``fspa`` is the automaton that judged them."""
