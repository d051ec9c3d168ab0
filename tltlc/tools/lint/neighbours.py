"""Find the source files that may import given files.

These are the source files in the same project, and in the folders above.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Final

_ROOTS: Final = ("tltl.toml", ".git")
"""A folder that contains a file or folder with one of these names is the root of a project."""


def neighbours(paths: Iterable[str]) -> dict[Path, str]:
    """Return the texts of the given files and of their neighbours, by resolved path.

    The neighbours of a file are the ``.tltl`` files below the root of its project, and those in the
    folders above the file. The root of the project is

    - the nearest folder that contains ``tltl.toml`` or ``.git``, beginning with the file's own;
    - else the current folder, if the file is below it;
    - else the folder of the file.

    Hidden folders and ``node_modules`` are left out, and so are files that cannot be read.
    """
    from tltlc.diagnostics.diagnostic import TltlError
    from tltlc.io.files import read_source

    files = {Path(os.path.realpath(path)) for path in paths}
    folders = {file.parent for file in files}
    inside = {file for root in {_root(folder) for folder in folders} for file in _sources_below(root)}
    above = {
        file for folder in {parent for child in folders for parent in child.parents} for file in _sources_in(folder)
    }
    texts: dict[Path, str] = {}
    for file in sorted(files | inside | above):
        try:
            texts[file] = read_source(file).text
        except TltlError:
            continue
    return texts


def _root(folder: Path) -> Path:
    for place in (folder, *folder.parents):
        if any(os.path.lexists(place / name) for name in _ROOTS):
            return place
    here = Path(os.path.realpath("."))
    return here if here in folder.parents else folder


def _sources_below(root: Path) -> Iterator[Path]:
    from tltlc.io.files import walk

    for folder, folders, _ in walk(root):
        folders[:] = [name for name in folders if not name.startswith(".") and name != "node_modules"]
        yield from _sources_in(Path(folder))


def _sources_in(folder: Path) -> list[Path]:
    try:
        return [file for file in folder.glob("*.tltl") if file.is_file()]
    except OSError:
        return []
