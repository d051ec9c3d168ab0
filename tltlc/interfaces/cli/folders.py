"""The source files that arguments name: themselves, or those of a folder."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.io.files import may_be_file, reading_error, walk

if TYPE_CHECKING:
    from tltlc.interfaces.cli.report import Report


def every_source(arguments: Iterable[str], report: Report) -> list[str]:
    """The files that arguments name, each once, in order; a folder that has none is reported, and left out."""
    found: dict[str, None] = {}
    for argument in arguments:
        try:
            found.update(dict.fromkeys(sources(argument)))
        except TltlError as error:
            report.add(error.diagnostics)
    return list(found)


def in_folders(arguments: Iterable[str]) -> list[str]:
    """The source files that are by now in those of the arguments that are folders."""
    return [file for argument in arguments if _is_folder(argument) for file in _inside(argument)]


def sources(argument: str) -> list[str]:
    """The argument itself, or the ``.tltl`` files in a folder and below it, hidden ones left out, in order.

    Errors: TLT0722 where a folder has none, TLT0001 where it cannot be read.
    """
    if not _is_folder(argument):
        return [argument]
    inside = _inside(argument)
    if not inside:
        raise TltlError([Diagnostic("TLT0722", f"there is no .tltl file in `{argument}`", help="name another folder")])
    return inside


def below(folder: Path, endings: tuple[str, ...] = (".tltl",)) -> list[Path]:
    """The files with these endings in a folder and below it, relative to it, in order.

    Hidden files are left out, and so are pipes and devices: reading one could take for ever.  Raises TltlError,
    TLT0001, for a folder that the system does not let us read: without its files an answer could be wrong.
    """
    found: list[Path] = []
    for place, folders, files in walk(folder, onerror=_unreadable):
        folders[:] = [name for name in folders if not name.startswith(".")]
        inside = Path(place).relative_to(folder)
        named = [name for name in files if name.endswith(endings) and not name.startswith(".")]
        found += [inside / name for name in named if may_be_file(os.path.join(place, name))]  # noqa: PTH118
    return sorted(found)


def is_free(folder: Path) -> bool:
    """Whether there is nothing of that name, or an empty folder."""
    try:
        return not os.path.lexists(folder) or not os.listdir(folder)  # noqa: PTH208
    except OSError:
        return False


def in_the_way(folder: Path, advice: str) -> TltlError:
    """TLT0722: a folder holds something, and a command makes whole folders only."""
    return TltlError([Diagnostic("TLT0722", f"`{folder}` is there already, and not empty", help=advice)])


def leads_out(path: str, arguments: Iterable[str]) -> bool:
    """Whether a file that no argument names is a link out of the folder in which it was found."""
    arguments = tuple(arguments)
    folders = [os.path.realpath(argument) for argument in arguments if _is_folder(argument)]
    place = os.path.realpath(path)
    return path not in arguments and not any(Path(place).is_relative_to(folder) for folder in folders)


def _unreadable(error: OSError) -> None:
    # A folder may be removed meanwhile.
    if not isinstance(error, FileNotFoundError):
        raise reading_error(str(error.filename), error)


def _inside(folder: str) -> list[str]:
    return [str(Path(folder, file)) for file in below(Path(folder))]


def _is_folder(argument: str) -> bool:
    return os.path.isdir(argument)  # noqa: PTH112 (pathlib raises where a name is too long)
