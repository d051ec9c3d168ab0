"""Films of the recorded episodes of a case, kept in the folder of the case for the next page."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any, Final

from tltl_runtime.regression.report.episode_films import CaseFilms
from tltl_runtime.regression.suite.result_cache import cache_text, inputs_hash, read_cache
from tltlc.api import TltlError, fileio, record

INDEX: Final = "films.json"
"""The name of the file, in the folder of a case, that says which films are kept there."""

_SUFFIX: Final = ".webp"


@record
class _KeptFilms:
    """The name of the file of each film, by the index of its episode, and the notes beside the films."""

    files: Mapping[str, str]
    notes: tuple[str, ...]


def films_hash(played: Any, place: tuple[str, str], recordings: dict[int, Path]) -> str:
    """Return the hash of everything that the films of a case depend on.

    ``played`` is the identity of what was played, as JSON data, ``place`` the level and its variant, and
    ``recordings`` maps the index of each recorded episode to its file.
    """
    hashes = {str(index): hashlib.sha256(path.read_bytes()).hexdigest() for index, path in recordings.items()}
    return inputs_hash([played, place, hashes])


def kept_films(folder: Path, inputs: str, draw: Callable[[], CaseFilms]) -> CaseFilms:
    """Return the films in ``folder`` if they were drawn from equal ``inputs``; otherwise, ``draw`` and keep them.

    ``inputs`` is the hash of :func:`films_hash`. If the game failed, nothing is kept: the next page tries
    again. A folder that cannot be written keeps nothing, either.
    """
    kept = read_cache(_KeptFilms, folder / INDEX, inputs)
    if kept is not None:
        with suppress(OSError):
            return CaseFilms(
                {int(index): (folder / name).read_bytes() for index, name in kept.files.items()}, kept.notes
            )
    films = draw()
    if not films.may_change:
        files = {str(index): f"{index}{_SUFFIX}" for index in films.pictures}
        pictures = {files[str(index)]: picture for index, picture in films.pictures.items()}
        with suppress(TltlError, OSError):
            for path in folder.glob(f"*{_SUFFIX}"):
                path.unlink(missing_ok=True)
            index = cache_text(inputs, _KeptFilms(files, films.notes))
            fileio.write_files(folder, {**pictures, INDEX: index}, "", over_inputs=True)
    return films
