"""Read the texts of a level's files, and load a level from the texts in a baseline."""

from __future__ import annotations

import hashlib
import re
from pathlib import Path
from typing import Final

from tltl_runtime.game.level import Level
from tltl_runtime.game.level_name import Variant
from tltl_runtime.game.registry import game_of
from tltl_runtime.regression.verdict.baseline import Reference, text_sha256
from tltlc.api import TltlError, fileio

Texts = tuple[tuple[str, str], ...]
"""Pairs for a level's files: the name, as in ``Level.files``, and either the text or its SHA-256."""

_NAME: Final = re.compile(r"(?:(?:assets|overlays)/)?[^/\\:\0]+\.toml")
_BASELINE: Final = fileio.Archive(
    "the baseline", damaged_help="record it again", elsewhere_help="record it again on this system"
)
_SPEC: Final = re.compile(r"^spec\s*=.*$", re.MULTILINE)


def level_texts(name_or_path: str, variant: Variant, files: Texts) -> Texts:
    """Return pairs of name and text for the ``files`` of a level, in order.

    ``name_or_path`` and ``variant`` say which level. ``files`` are pairs of a name and a SHA-256. A
    file that now has another SHA-256, because it was edited, is left out.
    """
    level_files = game_of(name_or_path).level_files
    texts = []
    for name, sha256 in files:
        candidates = (_text(place) for place in level_files.candidates(name_or_path, variant, name))
        text = next((text for text in candidates if text is not None and text_sha256(text) == sha256), None)
        if text is not None:
            texts.append((name, text))
    return tuple(texts)


def current_text(name_or_path: str, variant: Variant, name: str) -> str | None:
    """Return the current text of one of a level's files; None if it cannot be read.

    ``name`` is the name of the file in ``Level.files``. If there is no such file any more, the text is
    that of the level's main file. A line ends with a line feed, however it ends in the file.

    Raises TltlError: TLT0800 there is no such level.
    """
    level_files = game_of(name_or_path).level_files
    candidates = level_files.candidates(name_or_path, variant, name)
    return _text(next(filter(fileio.is_file, candidates), level_files.path(name_or_path)))


def is_unchanged(name_or_path: str, variant: Variant, name: str, sha256: str) -> bool:
    """Whether one of a level's files still has the content with this SHA-256; ``name`` is as for :func:`current_text`.

    Games hash the text of their files, or the bytes, with or without other line ends: a file that is not
    UTF-8, or begins with a byte order mark, has bytes that its text does not have.
    """
    text = current_text(name_or_path, variant, name)
    if text is not None and text_sha256(text) == sha256:
        return True
    path = next(filter(fileio.is_file, game_of(name_or_path).level_files.candidates(name_or_path, variant, name)), None)
    if path is None:
        return False
    try:
        data = fileio.read_bytes(path, str(path), fileio.limits.SCENE_FILE.size)
    except TltlError:
        return False
    return sha256 in (hashlib.sha256(data).hexdigest(), hashlib.sha256(data.replace(b"\r\n", b"\n")).hexdigest())


def baseline_level(reference: Reference) -> Level | None:
    """Load the level on which ``reference`` was recorded, from the texts that the baseline stores.

    The level has no spec of its own. Return None if a text is missing, if two files have the same name,
    if a name is not a plain file name, or if the level does not load.

    Raises TltlError: TLT0005 there is no place for temporary files.
    """
    played, texts = reference.played, dict(reference.texts)
    # Two overlays of the same name do not fit into one folder. No name may lead out of the folder.
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
            level: Level = game_of(name).load_level(str(folder / name), played.variant)
            return level
        except TltlError:
            return None


def _text(path: Path) -> str | None:
    try:
        return fileio.read_source(path).text.replace("\r\n", "\n")
    except TltlError:
        return None
