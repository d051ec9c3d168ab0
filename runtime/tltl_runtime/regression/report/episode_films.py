"""Films of the recorded episodes of a case, for the HTML page: animated pictures in the format WebP."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from io import BytesIO
from itertools import chain
from typing import Any, Final

import numpy as np

from tltl_runtime.game.episode import RecordedEpisode
from tltl_runtime.game.films import Films, Picture
from tltl_runtime.game.game import Game
from tltl_runtime.regression.explain.explain import Finding
from tltl_runtime.support.number_text import short_list
from tltlc.api import EMPTY, Diagnostic, TltlError, record

MOST_FILMS: Final = 6
"""A case has at most this many films."""
MOST_FRAMES: Final = 200
MOST_BYTES: Final = 1 << 20

_SIZE: Final = (320, 240)
"""The width and the height of a film, in pixels."""
_SHORTEST_S: Final = 0.02
_LONGEST_S: Final = 0.25
"""A frame is shown for at most this many seconds, however long a step takes."""
_LAST_S: Final = 1.5
"""The last frame is shown for this many seconds; then the film starts again."""
_QUALITIES: Final = (75, 40, 10)
"""The qualities to try, in percent, until a film is small enough."""
_LACKS_PICTURES: Final = "TLT0731"


@record
class CaseFilms:
    """The films of some episodes of a case.

    ``pictures`` are animated WebP pictures, by the index of the episode. ``notes`` are sentences
    about films that could not be made, with the reason. ``may_change`` says that another try
    may make other films, because the game failed.
    """

    pictures: Mapping[int, bytes] = EMPTY
    notes: tuple[str, ...] = ()
    may_change: bool = False


NO_FILMS: Final = CaseFilms()


def episode_films(
    game: Game[Any, Any],
    place: tuple[str, str],
    findings: Sequence[Finding],
    episodes: Mapping[int, RecordedEpisode],
    on_film: Callable[[int, int], None] = lambda *_: None,
) -> CaseFilms:
    """Return films of at most ``MOST_FILMS`` of the recorded ``episodes``.

    Examples of ``findings`` are preferred to other episodes. The game plays the episodes again to
    draw them. ``place`` names the level and its variant, as for ``Game.load_level``. ``on_film`` is
    called before each film, with the number of films so far and of all films. There are
    neither films nor notes if the game has no films, or if Pillow cannot write WebP. A game that could
    have films, but gives no pictures, has one note.
    """
    if game.films is None or not _can_write():
        return NO_FILMS
    pictures: dict[int, bytes] = {}
    failures: dict[str, list[int]] = {}
    examples = _examples(findings, episodes)
    for count, index in enumerate(examples):
        on_film(count, len(examples))
        try:
            episode = game.located(episodes[index], *place)
            pictures[index] = _film(game.films, episode)
        except TltlError as error:
            if error.diagnostics[0].code == _LACKS_PICTURES:
                return CaseFilms(notes=(_no_pictures_note(error.diagnostics[0]),))
            failures.setdefault(error.diagnostics[0].title, []).append(index)
    return CaseFilms(pictures, tuple(_note(indices, title) for title, indices in failures.items()), bool(failures))


def _examples(findings: Sequence[Finding], episodes: Mapping[int, RecordedEpisode]) -> list[int]:
    """Return the indices of at most ``MOST_FILMS`` episodes to show, in ascending order.

    The first example of each finding is preferred. Other episodes fill the remaining places.
    """
    firsts = (next((index for index in finding.episodes if index in episodes), None) for finding in findings)
    wanted = dict.fromkeys(index for index in chain(firsts, sorted(episodes)) if index is not None)
    return sorted([*wanted][:MOST_FILMS])


def _note(indices: Sequence[int], why: str) -> str:
    numbers = short_list([str(index) for index in indices], MOST_FILMS)
    return f"There is no film of {'episodes' if len(indices) > 1 else 'episode'} {numbers}: {why}."


def _no_pictures_note(diagnostic: Diagnostic) -> str:
    help_ = diagnostic.help or ""
    return f"There are no films: {diagnostic.title}." + (f" To see some, {help_}." if help_ else "")


def _film(films: Films[Any], episode: RecordedEpisode) -> bytes:
    """Return the film of an episode, as the bytes of a WebP file.

    Raises:
        TltlError: the episode cannot be played again, or the game draws no pictures of it.
    """
    rows = np.unique(np.linspace(0, len(episode.actions), MOST_FRAMES).round().astype(int))
    times = episode.times[rows]
    frames = [*films.frames(episode, times.tolist(), films.views[0], _SIZE, "english")]
    seconds = [*np.clip(np.diff(times), _SHORTEST_S, _LONGEST_S).tolist(), _LAST_S]
    return small_film(frames, seconds)


def small_film(frames: Sequence[Picture], seconds: Sequence[float]) -> bytes:
    """Return a film as the bytes of a WebP file, which shows the i-th frame for ``seconds[i]``.

    If the file is larger than ``MOST_BYTES``, the quality is lowered. If that is not enough, every
    second frame is dropped until the file is small enough or only the last frame is left.
    """
    for quality in _QUALITIES:
        film = _webp(frames, seconds, quality)
        if len(film) <= MOST_BYTES:
            return film
    while len(film) > MOST_BYTES and len(frames) > 1:
        # Backwards, so that the last frame remains.
        frames, kept = frames[::-2][::-1], seconds[::-2][::-1]
        seconds = [*(2 * shown for shown in kept[:-1]), kept[-1]]
        film = _webp(frames, seconds, _QUALITIES[-1])
    return film


def _webp(frames: Sequence[Picture], seconds: Sequence[float], quality: int) -> bytes:
    from PIL import Image

    first, *others = map(Image.fromarray, frames)
    data = BytesIO()
    durations = [round(1000 * shown) for shown in seconds]
    first.save(data, "WEBP", save_all=True, append_images=others, duration=durations, loop=0, quality=quality, method=2)
    return data.getvalue()


def _can_write() -> bool:
    """Whether the installed Pillow can write WebP pictures."""
    from PIL import features

    return bool(features.check("webp"))
