"""Find the files that a spec is made of: its own file and those that it imports."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

from tltlc.api import SourceFile, TltlError, compiler, fileio


def spec_files(spec: Path) -> Iterator[Path]:
    """Yield the file of a spec and all files that it imports, directly or indirectly, each once.

    The files need not compile. Paths that do not exist are yielded, too, if a file there would be
    imported instead of an existing one.
    """
    waiting, seen = [spec], {spec.resolve()}
    while waiting:
        path = waiting.pop()
        yield path
        for imported in _imports(path):
            if imported.resolve() not in seen:
                seen.add(imported.resolve())
                waiting.append(imported)


def up_to_first_file(paths: Iterable[Path]) -> Iterator[Path]:
    """Yield the paths up to and including the first file that exists; all paths if none exists."""
    for path in paths:
        yield path
        if fileio.is_file(path):
            return


def source_of(path: Path) -> SourceFile | None:
    """Return the text of a file; None if it cannot be read."""
    try:
        return fileio.read_source(path, max_bytes=fileio.MAX_ARTEFACT_BYTES)
    except TltlError:
        return None


def _imports(spec: Path) -> Iterator[Path]:
    text = source_of(spec)
    if text is None or spec.suffix != ".tltl":
        return
    folder = spec.absolute().parent
    # The project file sets where imports are searched.
    yield from up_to_first_file(place / fileio.PROJECT_FILE for place in (folder, *folder.parents))
    try:
        libraries = fileio.project_for(str(spec)).libraries
    except TltlError:
        libraries = ()
    yield from compiler.imported_files(text, libraries)
