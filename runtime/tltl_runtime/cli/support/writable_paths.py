"""Whether files can be written that a command is to write at its end."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryFile
from typing import Final

from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.io.files import descriptor_of, exists, is_file, reason
from tltlc.io.writing import check_not_read

_OUTPUT: Final = ("-", "/dev/stdout")


def check_writable(files: Mapping[str, Path | None]) -> None:
    """Check, before minutes of play, that files can be written; ``files`` are named by their options.

    Raises:
        TltlError: TLT0005 if one cannot be written, TLT0700 if one is an input of the command.
    """
    for option, path in files.items():
        if path is None or not _takes_a_place(path):
            continue
        check_not_read(path, f"name another place with {option}")
        try:
            # Its name may be one that the system does not allow.
            with suppress(FileNotFoundError):
                path.stat()
            # What a link leads to is what is written.
            with TemporaryFile(dir=path.resolve().parent):
                pass
        except OSError as error:
            why = "there is no such folder" if isinstance(error, FileNotFoundError) else reason(error)
            help_ = f"name another place with {option}"
            raise TltlError([Diagnostic("TLT0005", f"cannot write `{path}`: {why}", help=help_)]) from None


def check_apart(files: Mapping[str, Path | None], read: Iterable[Path]) -> None:
    """Raise TltlError, TLT0005, where a file would take the place of one that is ``read``, or of another of them;
    ``files`` are named by their options.
    """
    taken = {path.resolve(): "the suite reads it" for path in read}
    for option, path in files.items():
        if path is None or not _takes_a_place(path):
            continue
        place = path.resolve()
        if place in taken:
            help_ = f"name another place with {option}"
            raise TltlError([Diagnostic("TLT0005", f"cannot write `{path}`: {taken[place]}", help=help_)])
        taken[place] = f"{option} writes it, too"


def check_no_training(folder: Path) -> None:
    """Raise TltlError, TLT0005, where a folder is that of a training, which is to have its own files alone."""
    from tltl_runtime.training.run.run import RUN

    if exists(folder / RUN):
        title = f"cannot write into `{folder}`: it is the folder of a training"
        raise TltlError([Diagnostic("TLT0005", title, help="name another folder with --out")])


def is_output(path: Path) -> bool:
    """Whether a file that is asked for is standard output: by `-`, by its name among the devices, or by the name of
    the file that standard output goes to.
    """
    return str(path) in _OUTPUT or descriptor_of(path) == 1


def _takes_a_place(path: Path) -> bool:
    """Whether what is written replaces a file or makes one; what is no file, such as a pipe, is written to directly."""
    return not exists(path) or is_file(path)
