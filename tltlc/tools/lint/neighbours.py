"""The source files that may import those that a command names: theirs, and those of the same folder tree."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Final

_ROOTS: Final = ("tltl.toml", ".git")
"""A folder with one of these is where a tree begins."""


def neighbours(paths: Iterable[str]) -> dict[Path, str]:
    """The texts of these files, of those in their trees and of those in the folders above; what cannot be read is out.

    A tree begins at the project file or the repository, else at the current folder, else at the file's own folder.
    """
    from tltlc.diagnostics.diagnostic import TltlError
    from tltlc.io.files import read_source

    files = {Path(os.path.realpath(path)) for path in paths}
    folders = {file.parent for file in files}
    inside = {file for root in {_root(folder) for folder in folders} for file in _below(root)}
    above = {file for folder in {each for own in folders for each in own.parents} for file in _in(folder)}
    found: dict[Path, str] = {}
    for file in sorted(files | inside | above):
        try:
            found[file] = read_source(file).text
        except TltlError:
            continue
    return found


def _root(folder: Path) -> Path:
    for place in (folder, *folder.parents):
        if any(os.path.lexists(place / name) for name in _ROOTS):
            return place
    here = Path(os.path.realpath("."))
    return here if here in folder.parents else folder


def _below(root: Path) -> Iterator[Path]:
    from tltlc.io.files import walk

    for folder, folders, _ in walk(root):
        folders[:] = [name for name in folders if not name.startswith(".") and name != "node_modules"]
        yield from _in(Path(folder))


def _in(folder: Path) -> list[Path]:
    try:
        return [file for file in folder.glob("*.tltl") if file.is_file()]
    except OSError:
        return []
