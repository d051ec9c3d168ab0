"""An environment that records the episodes that are played in it."""

from __future__ import annotations

from typing import Any, Generic, TypeVar

import gymnasium

from tltl_runtime.game.episode import RecordedEpisode

EpisodeT = TypeVar("EpisodeT", bound=RecordedEpisode)


class EpisodeRecorder(gymnasium.Wrapper[Any, Any, Any, Any], Generic[EpisodeT]):
    """A wrapper that records the current episode. Observations, rewards and infos pass through unchanged.

    The wrapped environment is a :class:`~tltl_runtime.spec.wrapper.TltlEnv` over a game, or
    wrappers around one.
    """

    @property
    def episode(self) -> EpisodeT:
        """A copy of the episode so far; raises RuntimeError before the first reset."""
        raise NotImplementedError
