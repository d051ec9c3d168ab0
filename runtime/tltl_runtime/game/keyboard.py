"""A game that a person can play with the keyboard."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Generic, Literal, Protocol

from tltl_runtime.game.episode import RecordedEpisode
from tltl_runtime.game.recorder import EpisodeRecorder, EpisodeT
from tltlc.api import Diagnostic

Crouch = Literal["hold", "toggle"]
"""Whether the key for crouching must be held, or toggles it."""


class Recordings(Protocol):
    """A store for the episodes that a person plays."""

    def keep(self, episode: RecordedEpisode) -> None:
        """Write an unfinished episode, in place of the version that was written before."""

    def save(self, episode: RecordedEpisode) -> str:
        """Write a finished episode and return the name of its file."""


class Keyboard(ABC, Generic[EpisodeT]):
    """Lets a person play a game in a window."""

    views: tuple[str, ...]
    """The names of the views that the window can show, the usual one first."""

    keys: tuple[str, ...]
    """Lines that say which key does what."""

    render_mode: str | None = None
    """The render mode that the environments need; None if the window draws without their help."""

    @abstractmethod
    def play(
        self,
        env: EpisodeRecorder[EpisodeT],
        recordings: Recordings,
        *,
        seed: int | None,
        view: str,
        crouch: Crouch,
        enough: Callable[[], bool],
        on_lost: Callable[[Diagnostic], None],
    ) -> None:
        """Open a window and play episodes of ``env`` until the player stops.

        Playing also ends if ``enough`` returns true after an episode. ``recordings`` stores the
        episodes. ``seed`` is the seed of the first episode; None means a new one. ``view`` is the one of
        ``views`` that the window shows first. ``crouch`` says how the key for crouching works. ``on_lost``
        gets what happened if a game in another process is lost, which costs the episode.

        Raises:
            TltlError: TLT0830, no window can be opened; TLT0730, a package is not installed.
        """
