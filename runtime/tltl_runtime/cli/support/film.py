"""Write films of episodes."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Final, TypeVar

from tltl_runtime.stealth.world.player import DECISION
from tltlc.api import cli, record

if TYPE_CHECKING:
    from tltl_runtime.stealth.recordings.episode import Episode
    from tltl_runtime.stealth.rendering.film import FilmView
    from tltlc.api import Notation

T = TypeVar("T")

FILMS: Final = (".gif", ".mp4")
"""The file extensions of films."""

_MAX_FRAMES_PER_SECOND: Final = 30.0
"""The greatest default frame rate. If a film has more decisions per second, it skips some of them."""


@record
class Film:
    """The options of a film.

    ``rate`` is in frames per second. If it is None, the film has one frame per decision, but at
    most 30 frames per second. ``size`` is in pixels.
    """

    view: FilmView = "third_person"
    speed: float = 1.0
    rate: float | None = None
    size: tuple[int, int] = (640, 480)
    notation: Notation = "english"


def write_film(path: Path, episode: Episode, span: tuple[float, float], film: Film) -> None:
    """Write the film of an episode over a ``span`` of time, in seconds.

    The path's extension selects the format.

    Raises:
        TltlError: TLT0005, the file cannot be written; TLT0730, no encoder for .mp4 is installed.
    """
    from tltl_runtime.stealth.rendering.film import frames
    from tltl_runtime.stealth.rendering.film_file import NoEncoderError, write_gif, write_mp4
    from tltlc.api import fileio

    rate = film.rate or min(film.speed / DECISION, _MAX_FRAMES_PER_SECOND)
    start, stop = span
    count = int((stop - start) / film.speed * rate + 1e-6) + 1
    times = [start + number * film.speed / rate for number in range(count)]
    if times[-1] < stop - 1e-6 and stop == episode.snapshots[-1].time:
        # Always show the end of the episode.
        times.append(stop)
    pictures = _with_progress(frames(episode, times, film.view, film.size, film.notation), len(times))
    write: Callable[..., None] = write_gif if path.suffix.lower() == ".gif" else write_mp4
    try:
        with fileio.replace_file(path) as temporary:
            write(temporary, pictures, 1 / rate)
    except NoEncoderError as error:
        raise cli.exits.missing_component("an .mp4", "imageio-ffmpeg", "imageio-ffmpeg") from error


def _with_progress(pictures: Iterable[T], count: int) -> Iterator[T]:
    """Yield the pictures of a film, and show a progress bar if standard error is a terminal."""
    if not sys.stderr.isatty():
        yield from pictures
        return
    from rich.console import Console
    from rich.progress import track

    yield from track(pictures, "drawing", total=count, console=Console(stderr=True), transient=True)
