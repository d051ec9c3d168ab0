"""A person's session at the keyboard: episode after episode, each of which is recorded."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Generic

from tltl_runtime.game.keyboard import Recordings
from tltl_runtime.game.recorder import EpisodeRecorder, EpisodeT


class PlaySession(ABC, Generic[EpisodeT]):
    """Lets a person play episodes of ``env``, and passes them to ``recordings``.

    Play ends when the person stops, or when ``enough()`` is true after an episode.

    ``recordings.save`` gets each episode once: at its end, when the person restarts, or when play
    stops for any reason, including an exception such as KeyboardInterrupt. ``recordings.keep`` gets
    an unfinished episode every few seconds.
    """

    def __init__(
        self, env: EpisodeRecorder[EpisodeT], recordings: Recordings, enough: Callable[[], bool] = lambda: False
    ) -> None:
        self._env, self._recordings, self._enough = env, recordings, enough
        self._unsaved = False
        """Whether the episode has steps that ``recordings.save`` has not got."""

    def play(self, seed: int | None) -> None:
        """Play episodes until the person stops or ``enough()`` is true.

        ``seed`` is the seed of the first episode; None means a new one.
        """
        going = True
        try:
            while going:
                going = self._episode(seed) and not self._enough()
                seed = None
        finally:
            self._save()

    @abstractmethod
    def _episode(self, seed: int | None) -> bool:
        """Play one episode; return whether the person wants another."""

    def _save(self) -> str | None:
        """Save the episode and return the name of its file; None if nothing new has been played."""
        if not self._unsaved:
            return None
        file = self._recordings.save(self._env.episode)
        # Set this last: if saving is interrupted, the next call must save again.
        self._unsaved = False
        return file
