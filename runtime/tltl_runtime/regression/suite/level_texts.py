"""The texts of the files that a level is made of: read as they are, and made a level of again."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Final

from tltl_runtime.regression.verdict.baseline import Reference, text_sha256
from tltl_runtime.stealth.level import Level
from tltl_runtime.stealth.levels.file import level_path, load_level
from tltl_runtime.stealth.levels.made_for import LEVELS
from tltl_runtime.stealth.levels.place import overlays_of
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.io.archive import Archive, unpack
from tltlc.io.files import is_file, read_source
from tltlc.io.temporary import temporary_folder

Texts = tuple[tuple[str, str], ...]
"""Names of files, as the files of a :class:`~tltl_runtime.stealth.level.Level` have them, and what is in them."""

_NAME: Final = re.compile(r"(?:(?:assets|overlays)/)?[^/\\:\0]+\.toml")
_BASELINE: Final = Archive("the baseline", damaged="record it anew", elsewhere="record it anew on this system")
_SPEC: Final = re.compile(r"^spec\s*=.*$", re.MULTILINE)


def level_texts(name_or_path: str, variant: str, files: Texts) -> Texts:
    """The texts of a level's ``files``, which are given with their SHA-256, in their order.

    A file that was edited meanwhile is left out.
    """
    path = level_path(name_or_path)
    found = []
    for name, sha256 in files:
        texts = (_text(place) for place in _places(path, variant, name))
        text = next((each for each in texts if each is not None and text_sha256(each) == sha256), None)
        if text is not None:
            found.append((name, text))
    return tuple(found)


def text_now(name_or_path: str, variant: str, name: str) -> str | None:
    """The text of a file that a level would be made of now; None where it cannot be read."""
    path = level_path(name_or_path)
    return _text(next(filter(is_file, _places(path, variant, name)), path))


def designed(reference: Reference) -> Level | None:
    """The level as it was when a baseline was recorded; None where its texts do not make one any more."""
    played, texts = reference.played, dict(reference.texts)
    # Two overlays of one name cannot lie in one folder, and names that lead out of it are none of a level.
    if len(texts) != len(played.files) or not texts or not all(map(_NAME.fullmatch, texts)):
        return None
    name = played.files[0][0]
    if name not in texts:
        return None
    # The spec of the level lies elsewhere, and nothing here shows it.
    texts[name] = _SPEC.sub("", texts[name], count=1)
    files = [(file, text.encode("utf-8", "surrogatepass")) for file, text in texts.items()]
    with temporary_folder() as folder:
        try:
            unpack(folder, files, _BASELINE)
            return load_level(str(folder / name), played.variant)
        except TltlError:
            return None


def _places(level: Path, variant: str, name: str) -> Iterator[Path]:
    """Where a file of a level may lie: the level's own, one beside it or in the package, or an overlay's."""
    if name == level.name:
        yield level
    yield from (level.parent / name, LEVELS / name)
    for each in overlays_of(variant)[1]:
        if each.endswith(".toml") and f"overlays/{Path(each).name}" == name:
            yield Path(each)


def _text(path: Path) -> str | None:
    try:
        return read_source(path).text.replace("\r\n", "\n")
    except TltlError:
        return None
