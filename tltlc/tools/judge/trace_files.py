"""Find the traces that the arguments of a command name: files, and folders with files."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from os.path import normpath
from pathlib import Path
from typing import Final

from tltlc.core.record import record
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.io.files import files_below, is_dir

_TAPES: Final = (".tape.jsonl.gz", ".tape.jsonl")
ENDINGS: Final = (*_TAPES, ".csv", ".jsonl", ".parquet")
"""The endings of the names of traces in a folder; a longer one comes before one that it ends in."""


@record
class TraceFiles:
    """The files that the arguments of a command name.

    ``traces`` are the paths of the traces, in order and without duplicates. ``others`` are the paths
    of all other files in the named folders. ``errors`` has an error TLT0001 for each folder that
    cannot be read or contains no trace.
    """

    traces: tuple[str, ...]
    others: tuple[str, ...]
    errors: tuple[Diagnostic, ...]


def find_traces(arguments: Iterable[str]) -> TraceFiles:
    """Return the traces that the arguments name. An argument is a file or a folder.

    A file counts as a trace, whatever its name. A folder stands for all files in it and in its
    subfolders, sorted; the files with one of the ``ENDINGS`` are traces. Hidden files and folders
    in it are left out, and so is a tape beside a trace with the same name, which has the same play.
    """
    traces: dict[str, str] = {}
    others: dict[str, str] = {}
    errors: list[Diagnostic] = []
    for argument in arguments:
        if not is_dir(argument):
            traces.setdefault(normpath(argument), argument)
            continue
        try:
            files = [str(Path(argument, path)) for path in files_below(Path(argument), ("",))]
        except TltlError as error:
            errors += error.diagnostics
            continue
        if not any(file.lower().endswith(ENDINGS) for file in files):
            title = f"the folder `{argument}` contains no trace"
            errors.append(Diagnostic("TLT0001", title, help=f"the names of traces end in {', '.join(ENDINGS)}"))
        for file in _without_repeated(files):
            (traces if file.lower().endswith(ENDINGS) else others).setdefault(normpath(file), file)
    not_traces = tuple(file for key, file in others.items() if key not in traces)
    return TraceFiles(tuple(traces.values()), not_traces, tuple(errors))


def _without_repeated(files: Sequence[str]) -> list[str]:
    """Return the files without the tapes of plays that are there twice.

    A trace of the same name has the same play as a tape, and an unpacked tape the same as a packed one.
    """
    endings: dict[str, set[str]] = {}
    for file in files:
        name, ending = _split(file)
        endings.setdefault(name, set()).add(ending)
    kept = []
    for file in files:
        name, ending = _split(file)
        if ending not in _TAPES or not endings[name] & set(ENDINGS[ENDINGS.index(ending) + 1 :]):
            kept.append(file)
    return kept


def _split(file: str) -> tuple[str, str]:
    """Return a path without its ending, and this ending; it is empty if the file is no trace."""
    ending = next((ending for ending in ENDINGS if file.lower().endswith(ending)), "")
    return file[: len(file) - len(ending)], ending
