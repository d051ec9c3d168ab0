"""Check early whether a command can write the files that it writes at its end."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryFile
from typing import Final

from tltlc.api import Diagnostic, TltlError, fileio

_OUTPUT: Final = ("-", "/dev/stdout")


def check_writable(files: Mapping[str, Path | None]) -> None:
    """Check that the output files can be written, before the command plays for minutes.

    ``files`` maps options, such as ``--json``, to the files that they name; None is ignored.

    Raises:
        TltlError: TLT0005 if a file cannot be written, TLT0700 if a file is an input of the command.
    """
    for option, path in files.items():
        if path is None or not _creates_file(path):
            continue
        fileio.check_not_read(path, f"name another place with {option}")
        try:
            # If the system does not allow the name, this raises an error.
            with suppress(FileNotFoundError):
                path.stat()
            # If the path is a link, the file is written in the folder of its target.
            with TemporaryFile(dir=path.resolve().parent):
                pass
        except OSError as error:
            reason = "there is no such folder" if isinstance(error, FileNotFoundError) else fileio.reason(error)
            help_ = f"name another place with {option}"
            raise TltlError([Diagnostic("TLT0005", f"cannot write `{path}`: {reason}", help=help_)]) from None


def check_apart(files: Mapping[str, Path | None], inputs: Iterable[Path]) -> None:
    """Raise TltlError, TLT0005, if an output file would overwrite one of ``inputs`` or another output file.

    ``files`` maps options, such as ``--json``, to the output files that they name; None is ignored.
    ``inputs`` are the files that the suite reads.
    """
    uses = {path.resolve(): "the suite reads it" for path in inputs}
    for option, path in files.items():
        if path is None or not _creates_file(path):
            continue
        target = path.resolve()
        if target in uses:
            help_ = f"name another place with {option}"
            raise TltlError([Diagnostic("TLT0005", f"cannot write `{path}`: {uses[target]}", help=help_)])
        uses[target] = f"{option} writes it, too"


def check_no_training(folder: Path) -> None:
    """Raise TltlError, TLT0005, if a folder contains a training: no other files may go there."""
    from tltl_runtime.training.files.run_file import RUN

    if fileio.exists(folder / RUN):
        title = f"cannot write into `{folder}`: it is the folder of a training"
        raise TltlError([Diagnostic("TLT0005", title, help="name another folder with --out")])


def is_standard_output(path: Path) -> bool:
    """Whether a path is ``-``, ``/dev/stdout``, or the file that standard output is redirected to."""
    return str(path) in _OUTPUT or fileio.descriptor_of(path) == 1


def _creates_file(path: Path) -> bool:
    """Whether writing to a path creates or replaces a file. Pipes and devices are written directly."""
    return not fileio.exists(path) or fileio.is_file(path)
