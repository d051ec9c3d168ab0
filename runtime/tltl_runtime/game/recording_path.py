"""The names of the files of recorded episodes."""

from __future__ import annotations

import os
from collections.abc import Collection
from pathlib import Path
from typing import Final

from tltl_runtime.game.episode import RecordedEpisode

SUFFIX: Final = ".episode.npz"


def file_stem(episode: RecordedEpisode) -> str:
    """Return the name of an episode's files without their endings: ``LEVEL-VARIANT-SEED``."""
    return f"{episode.level.name}-{episode.level.variant}-{episode.seed}"


def new_path(folder: Path, stem: str, content: bytes | None = None, pictures: Collection[str] = ()) -> Path:
    """Return a path for a new recording, so that no other file is overwritten.

    It is the first of ``STEM.episode.npz``, ``STEM-2.episode.npz`` and so on that is free. ``pictures``
    are the endings of files that the caller writes beside the recording, such as ``.png``; these must be
    free, too. A recording with exactly this ``content`` may be overwritten, and so may its pictures.
    """
    name, number = stem, 1
    while not _is_free(folder, name, content, pictures):
        number += 1
        name = f"{stem}-{number}"
    return folder / f"{name}{SUFFIX}"


def _is_free(folder: Path, name: str, content: bytes | None, pictures: Collection[str]) -> bool:
    path = folder / f"{name}{SUFFIX}"
    if os.path.lexists(path):
        return path.is_file() and path.read_bytes() == content
    return not any(os.path.lexists(folder / f"{name}{ending}") for ending in pictures)
