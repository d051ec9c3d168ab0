"""The films of episodes of the stealth game."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import cast

from tltl_runtime.game.films import Films, Picture
from tltl_runtime.stealth.recordings.episode import Episode
from tltl_runtime.stealth.rendering.camera import FILM_VIEWS, FilmView
from tltlc.api import Notation


class StealthFilms(Films[Episode]):
    """Draws films with cameras, and of the level's plan. It imports the renderer only when it draws."""

    views = FILM_VIEWS

    def frames(
        self, episode: Episode, times: Sequence[float], view: str, size: tuple[int, int], notation: Notation
    ) -> Iterator[Picture]:
        """Yield a picture for each time, with a strip that shows the automaton's judgement."""
        from tltl_runtime.stealth.rendering.film import frames

        return frames(episode, times, cast(FilmView, view), size, notation)
