"""Find the source files for the arguments of a command, which are paths of files and folders."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.io.files import files_below

if TYPE_CHECKING:
    from tltlc.interfaces.cli.report import Report


def every_source(arguments: Iterable[str], report: Report) -> list[str]:
    """Return the source files for all arguments, each once, in order (see :func:`sources`).

    Folders that contain no source file or cannot be read are reported and skipped.
    """
    paths: dict[str, None] = {}
    for argument in arguments:
        try:
            paths.update(dict.fromkeys(sources(argument)))
        except TltlError as error:
            report.add(error.diagnostics)
    return list(paths)


def files_in_folders(arguments: Iterable[str]) -> list[str]:
    """Return the source files in and below the folders among the arguments; skip other arguments."""
    return [file for argument in arguments if _is_folder(argument) for file in _files_inside(argument)]


def sources(argument: str) -> list[str]:
    """Return the source files of one argument.

    For a folder, these are the ``.tltl`` files in and below it, sorted, without hidden ones. Any other
    argument is returned unchanged, even if there is no such file.

    Raises TltlError: TLT0722 if the folder contains no such file, TLT0001 if a folder cannot be
    read.
    """
    if not _is_folder(argument):
        return [argument]
    files = _files_inside(argument)
    if not files:
        raise TltlError([Diagnostic("TLT0722", f"there is no .tltl file in `{argument}`", help="name another folder")])
    return files


def is_free(folder: Path) -> bool:
    """Whether a command may create this folder: the path does not exist, or is an empty folder."""
    try:
        return not os.path.lexists(folder) or not os.listdir(folder)  # noqa: PTH208
    except OSError:
        return False


def occupied_folder_error(folder: Path, advice: str) -> TltlError:
    """Return error TLT0722 for a folder that a command must create, but whose path is not free (:func:`is_free`).

    ``advice`` is the help of the error.
    """
    return TltlError([Diagnostic("TLT0722", f"`{folder}` already exists and is not an empty folder", help=advice)])


def links_outside(path: str, arguments: Iterable[str]) -> bool:
    """Whether ``path``, found in a folder that the user named, is a link to a file outside all these folders.

    ``arguments`` are the files and folders that the user named. False if ``path`` is itself one of
    them.
    """
    arguments = tuple(arguments)
    folders = [os.path.realpath(argument) for argument in arguments if _is_folder(argument)]
    place = os.path.realpath(path)
    return path not in arguments and not any(Path(place).is_relative_to(folder) for folder in folders)


def _files_inside(folder: str) -> list[str]:
    return [str(Path(folder, file)) for file in files_below(Path(folder))]


def _is_folder(argument: str) -> bool:
    return os.path.isdir(argument)  # noqa: PTH112 (pathlib raises where a name is too long)
