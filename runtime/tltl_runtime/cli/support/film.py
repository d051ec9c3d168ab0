"""Writing films of episodes, for the commands that do."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Final, TypeVar

from tltl_runtime.stealth.world.player import DECISION
from tltlc.core.record import record
from tltlc.interfaces.cli import exits

if TYPE_CHECKING:
    from tltl_runtime.stealth.recordings.episode import Episode
    from tltl_runtime.stealth.recordings.summary import Notation
    from tltl_runtime.stealth.rendering.film import View

T = TypeVar("T")

FILMS: Final = (".gif", ".mp4")
"""The endings of films."""

_MOST_FRAMES_A_SECOND: Final = 30.0
"""Unless asked for, a faster film leaves decisions out."""


@record
class Film:
    """How a film is made: ``rate`` in pictures a second, None for one each decision; ``size`` in pixels."""

    view: View = "third_person"
    speed: float = 1.0
    rate: float | None = None
    size: tuple[int, int] = (640, 480)
    notation: Notation = "english"


def write_film(path: Path, episode: Episode, span: tuple[float, float], film: Film) -> None:
    """Write the film of an episode from one time to another, in seconds; the ending of the path says which kind.

    Errors: TLT0005, and TLT0730 where nothing here writes an .mp4.
    """
    from tltl_runtime.stealth.rendering.film import frames
    from tltl_runtime.stealth.rendering.film_file import NoEncoderError, write_gif, write_mp4
    from tltlc.io.writing import replaced

    rate = film.rate or min(film.speed / DECISION, _MOST_FRAMES_A_SECOND)
    start, stop = span
    count = int((stop - start) / film.speed * rate + 1e-6) + 1
    times = [start + number * film.speed / rate for number in range(count)]
    if times[-1] < stop - 1e-6 and stop == episode.snapshots[-1].time:
        # How it ended is always to be seen.
        times.append(stop)
    pictures = _counted(frames(episode, times, film.view, film.size, film.notation), len(times))
    write: Callable[..., None] = write_gif if path.suffix.lower() == ".gif" else write_mp4
    try:
        with replaced(path) as temporary:
            write(temporary, pictures, 1 / rate)
    except NoEncoderError as error:
        raise exits.missing_component("an .mp4", "imageio-ffmpeg", "imageio-ffmpeg") from error


def _counted(pictures: Iterable[T], count: int) -> Iterator[T]:
    """The pictures, with a bar on a terminal's standard error that says how far they are."""
    if not sys.stderr.isatty():
        yield from pictures
        return
    from rich.console import Console
    from rich.progress import track

    yield from track(pictures, "drawing", total=count, console=Console(stderr=True), transient=True)
