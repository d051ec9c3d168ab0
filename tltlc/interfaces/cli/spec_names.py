"""If the argument of a command is the name of a spec instead of a file, suggest the file of this spec."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from typing import Final

from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.io.files import exists, is_file, may_be_file, read_source, walk
from tltlc.io.spec_file import is_plain_name

_MOST_FOLDERS: Final = 200
_MOST_FILES: Final = 200
_MOST_SUGGESTIONS: Final = 3


def with_suggestion(error: TltlError, argument: str) -> TltlError:
    """Add to an error about ``argument`` the suggestion of a file that the user may mean.

    Return the error with the suggestion, ``NAME.tltl`` or ``FILE:NAME``, as its help. Return it
    unchanged if the path ``argument`` exists, or if no file fits.
    """
    if exists(argument):
        return error
    if is_file(f"{argument}.tltl"):
        suggestions = [f"{argument}.tltl"]
    elif is_plain_name(argument):
        suggestions = [f"{path}:{argument}" for path in islice(_files_declaring(argument), _MOST_SUGGESTIONS)]
    else:
        suggestions = []
    if not suggestions:
        return error
    help_ = f"did you mean {' or '.join(f'`{suggestion}`' for suggestion in suggestions)}?"
    return TltlError([replace(diagnostic, help=help_) for diagnostic in error.diagnostics])


def _files_declaring(name: str) -> Iterator[Path]:
    """Yield files in and below the current folder that declare a spec of this name.

    Only the first 200 files in the first 200 folders are searched.
    """
    from tltlc.grammar.parser import parse
    from tltlc.grammar.tree import SpecDecl

    for path in islice(_visible_sources(), _MOST_FILES):
        try:
            source = read_source(path)
        except TltlError:
            continue
        if name in source.text:
            module, _ = parse(source)
            if any(
                isinstance(declaration, SpecDecl) and declaration.name == name for declaration in module.declarations
            ):
                yield path


def _visible_sources() -> Iterator[Path]:
    """Yield the source files in and below the current folder; those in the folder itself come first.

    Hidden files and folders, pipes and devices are skipped, and so are all folders after the first
    200.
    """
    for place, folders, files in islice(walk("."), _MOST_FOLDERS):
        folders[:] = sorted(name for name in folders if not name.startswith("."))
        paths = (Path(place, name) for name in sorted(files) if name.endswith(".tltl") and not name.startswith("."))
        yield from filter(may_be_file, paths)
