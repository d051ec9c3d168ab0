"""Update imports when files or folders are renamed, so that they still lead to the same files."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from os.path import dirname, normpath, relpath
from pathlib import Path, PurePath

from tltlc.diagnostics.diagnostic import Edit
from tltlc.grammar.quotes import quote
from tltlc.grammar.tables import load
from tltlc.grammar.tree import Import
from tltlc.interfaces.lsp.document import Document
from tltlc.interfaces.lsp.paths import is_below, location_of
from tltlc.interfaces.lsp.workspace import Workspace

FileMoves = Sequence[tuple[str, str]]
"""Old and new paths of renamed files and folders."""


def edits_of_moves(moves: FileMoves, workspace: Workspace) -> list[tuple[Document, list[Edit]]]:
    """Return the edits of imports that are needed after files are renamed, by document.

    ``moves`` contains the old and new paths of the renamed files and folders. Documents without
    edits are left out.
    """
    changes = [
        (document, list(_edits(document, moves))) for document in workspace.all() if may_import(document.source.text)
    ]
    return [(document, edits) for document, edits in changes if edits]


def may_import(text: str) -> bool:
    """Whether a source text may import files: it contains the word ``import``."""
    return "import" in text


def _edits(document: Document, moves: FileMoves) -> Iterator[Edit]:
    here = location_of(document.source)
    for declaration, loaded in document.resolution.modules[-1].imports:
        there = location_of(loaded.module.source)
        if loaded.module.source.kind == "standard library":
            continue
        if (_path_after(here, moves), _path_after(there, moves)) != (here, there):
            folder = dirname(_path_after(here, moves))  # noqa: PTH120
            target = _target(declaration, _path_after(there, moves), folder, document.project.libraries)
            current_target = document.source.slice(declaration.target_span)
            if (
                target is not None
                and target != current_target
                and not _leads_to(declaration, folder, _path_after(there, moves))
            ):
                yield Edit(declaration.target_span, target)


def _path_after(path: str, moves: FileMoves) -> str:
    for old, new in moves:
        if is_below(path, old):
            return new + path[len(old) :]
    return path


def _leads_to(declaration: Import, folder: str, there: str) -> bool:
    """Whether an import by path, written in a file in ``folder``, leads to the path ``there``."""
    return declaration.is_path and normpath(PurePath(folder, declaration.target)) == there


def _target(declaration: Import, there: str, folder: str, libraries: tuple[Path, ...]) -> str | None:
    """Return the text after ``import`` with which a file in ``folder`` imports the file at path ``there``.

    If ``declaration`` imports by name, and the file is in or below ``folder`` or one of
    ``libraries``, this is a name, such as ``game.doors`` for ``game/doors.tltl``. Otherwise, and if a
    part of the path is not a valid name, it is a relative path in quotation marks. Return None if
    the path cannot be quoted in a source text.
    """
    if not declaration.is_path:
        for place in (folder, *map(str, libraries)):
            if is_below(there, place):
                parts = PurePath(there).relative_to(place).with_suffix("").parts
                if all(part.isidentifier() and part.isascii() and part not in load().words for part in parts):
                    return ".".join(parts)
    return quote(PurePath(relpath(there, folder)).as_posix())
