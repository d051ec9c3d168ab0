"""Whether files can be written that a command is to write at its end."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryFile

from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.files import exists, is_file, reason


def check_writable(files: Mapping[str, Path | None]) -> None:
    """Raise TltlError, TLT0005, where a file cannot be written; ``files`` are named by their options.

    Better to know before minutes of play.
    """
    for option, path in files.items():
        # What is no file, such as a pipe, is written to directly.
        if path is None or (exists(path) and not is_file(path)):
            continue
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
