"""The texts of the files of a level: read them, and load a level from them."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Final

from tltl_runtime.game.place import overlays_of
from tltl_runtime.regression.verdict.baseline import Reference, text_sha256
from tltl_runtime.stealth.level import Level
from tltl_runtime.stealth.levels.file import level_path, load_level
from tltl_runtime.stealth.levels.made_for import LEVELS
from tltlc.api import TltlError, fileio

Texts = tuple[tuple[str, str], ...]
"""Names of files, as in ``files`` of a :class:`~tltl_runtime.stealth.level.Level`, each with a text or a hash."""

_NAME: Final = re.compile(r"(?:(?:assets|overlays)/)?[^/\\:\0]+\.toml")
_BASELINE: Final = fileio.Archive("the baseline", damaged="record it anew", elsewhere="record it anew on this system")
_SPEC: Final = re.compile(r"^spec\s*=.*$", re.MULTILINE)


def level_texts(name_or_path: str, variant: str, files: Texts) -> Texts:
    """Read the texts of a level's ``files``, which are names with SHA-256 hashes, in order.

    A file that was edited since, and so has another hash, is left out.
    """
    path = level_path(name_or_path)
    texts = []
    for name, sha256 in files:
        candidates = (_text(place) for place in _places(path, variant, name))
        text = next((text for text in candidates if text is not None and text_sha256(text) == sha256), None)
        if text is not None:
            texts.append((name, text))
    return tuple(texts)


def text_now(name_or_path: str, variant: str, name: str) -> str | None:
    """The current text of a file of a level; None if it cannot be read."""
    path = level_path(name_or_path)
    return _text(next(filter(fileio.is_file, _places(path, variant, name)), path))


def designed(reference: Reference) -> Level | None:
    """Load the level from the texts of a baseline, as it was recorded; None if they do not load."""
    played, texts = reference.played, dict(reference.texts)
    # Two overlays of the same name do not fit into one folder.  Reject names that lead out of the folder.
    if len(texts) != len(played.files) or not texts or not all(map(_NAME.fullmatch, texts)):
        return None
    name = played.files[0][0]
    if name not in texts:
        return None
    # Remove the level's spec: its file is not among the texts, and a map does not need it.
    texts[name] = _SPEC.sub("", texts[name], count=1)
    files = [(file, text.encode("utf-8", "surrogatepass")) for file, text in texts.items()]
    with fileio.temporary_folder() as folder:
        try:
            fileio.unpack(folder, files, _BASELINE)
            return load_level(str(folder / name), played.variant)
        except TltlError:
            return None


def _places(level: Path, variant: str, name: str) -> Iterator[Path]:
    """The possible paths of a level's file: the level itself, beside the level, in the package, or an added overlay."""
    if name == level.name:
        yield level
    yield from (level.parent / name, LEVELS / name)
    for overlay in overlays_of(variant)[1]:
        if overlay.endswith(".toml") and f"overlays/{Path(overlay).name}" == name:
            yield Path(overlay)


def _text(path: Path) -> str | None:
    try:
        return fileio.read_source(path).text.replace("\r\n", "\n")
    except TltlError:
        return None
