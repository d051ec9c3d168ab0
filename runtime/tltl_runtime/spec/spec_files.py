"""Find the files on which a spec depends: its own file, its imports and project files."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

from tltlc.api import SourceFile, TltlError, compiler, fileio


def spec_files(spec: Path) -> Iterator[Path]:
    """Yield the files on which a spec depends, each once, beginning with its own file.

    These are all files that the spec imports, directly or indirectly, and the project file
    (``tltl.toml``) that says where imports are searched. The files need not compile. A path that does
    not exist is yielded, too, if a file created there would be read in place of an existing file.
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
    """Yield ``paths`` up to and including the first existing file; all of them if none is a file."""
    for path in paths:
        yield path
        if fileio.is_file(path):
            return


def source_of(path: Path) -> SourceFile | None:
    """Return the source text in a file; None if it cannot be read."""
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
