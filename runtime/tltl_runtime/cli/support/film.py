"""Write films of episodes."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, TypeVar

import click

from tltl_runtime.game.capability_error import capability_error
from tltl_runtime.game.films import Films
from tltlc.api import cli, record

if TYPE_CHECKING:
    from tltl_runtime.game.episode import RecordedEpisode
    from tltl_runtime.game.level import Level
    from tltlc.api import Notation

T = TypeVar("T")

FILMS: Final = (".gif", ".mp4")
"""The file extensions of films."""

_MAX_FRAMES_PER_SECOND: Final = 30.0
"""The greatest default frame rate. If a film has more decisions per second, it skips some of them."""


@record
class Film:
    """The options of a film.

    ``view`` is the name of one of the game's views, such as ``top_down``; None means the game's first
    view. A ``speed`` of 2 is twice as fast as the game. ``rate`` is in frames per second. If it is
    None, the film has one frame per decision, but at most 30 frames per second. ``size`` is the width
    and height in pixels. ``notation`` is the notation of formulas in the film.
    """

    view: str | None = None
    speed: float = 1.0
    rate: float | None = None
    size: tuple[int, int] = (640, 480)
    notation: Notation = "english"


def films_of(level: Level) -> Films[Any]:
    """Return the object that draws films of a level's game; raises TltlError, TLT0731, if the game has no films."""
    films = level.game.films
    if films is None:
        raise capability_error(level, "has no films", "write the signals instead: `tltlc replay RECORDING -o NAME.csv`")
    return films


def write_film(path: Path, episode: RecordedEpisode, span: tuple[float, float], film: Film) -> None:
    """Write a film of a part of an episode; the extension of ``path`` selects the format.

    ``span`` is the start and the end of the part, in seconds since the reset.

    Raises:
        TltlError: TLT0005, the file cannot be written; TLT0730, no encoder for .mp4 is installed;
            TLT0731, the game has no films.
        UsageError: the game has no such view.
    """
    films = films_of(episode.level)
    if film.view is not None and film.view not in films.views:
        message = f"the films of `{episode.level.name}` have no view `{film.view}`: they have {', '.join(films.views)}"
        raise click.UsageError(message, click.get_current_context(silent=True))
    from tltl_runtime.cli.support.film_file import NoEncoderError, write_gif, write_mp4
    from tltlc.api import fileio

    rate = film.rate or min(film.speed / _step_s(episode), _MAX_FRAMES_PER_SECOND)
    start, stop = span
    count = int((stop - start) / film.speed * rate + 1e-6) + 1
    times = [start + number * film.speed / rate for number in range(count)]
    if times[-1] < stop - 1e-6 and stop == episode.times[-1]:
        # Always show the end of the episode.
        times.append(stop)
    frames = films.frames(episode, times, film.view or films.views[0], film.size, film.notation)
    pictures = _with_progress(frames, len(times))
    write: Callable[..., None] = write_gif if path.suffix.lower() == ".gif" else write_mp4
    try:
        with fileio.replace_file(path) as temporary:
            write(temporary, pictures, 1 / rate)
    except NoEncoderError as error:
        raise cli.exits.missing_component("an .mp4", "imageio-ffmpeg", "imageio-ffmpeg") from error


def _step_s(episode: RecordedEpisode) -> float:
    """Return the mean time between two decisions of an episode, in seconds; 1 if the episode takes no time."""
    return round(float(episode.times[-1]) / max(1, len(episode.actions)), 9) or 1.0


def _with_progress(pictures: Iterable[T], count: int) -> Iterator[T]:
    """Yield the pictures of a film, and show a progress bar if standard error is a terminal."""
    if not sys.stderr.isatty():
        yield from pictures
        return
    from rich.console import Console
    from rich.progress import track

    yield from track(pictures, "drawing", total=count, console=Console(stderr=True), transient=True)
