"""The films of episodes of the stealth game."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import cast

from tltl_runtime.game.films import Films, Picture
from tltl_runtime.stealth.recordings.episode import Episode
from tltl_runtime.stealth.rendering.camera import FILM_VIEWS, FilmView
from tltlc.api import Notation


class StealthFilms(Films[Episode]):
    """Draws films of episodes, seen by a camera or as a plan (a map from above).

    The renderer is imported only when a film is drawn.
    """

    views = FILM_VIEWS

    def frames(
        self, episode: Episode, times: Sequence[float], view: str, size: tuple[int, int], notation: Notation
    ) -> Iterator[Picture]:
        """Yield an RGB picture of ``size`` (width, height) for each of ``times``, in seconds since the reset.

        A strip below the view shows the time, the progress, the health, and what remains to be
        satisfied.
        """
        from tltl_runtime.stealth.rendering.film import frames

        return frames(episode, times, cast(FilmView, view), size, notation)
