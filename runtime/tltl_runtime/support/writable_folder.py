"""Check that files can be written into a folder, before something long begins."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryFile

from tltlc.api import Diagnostic, TltlError, fileio


def writable_folder(folder: Path) -> Path:
    """Create ``folder`` if it is missing, test that files can be written into it, and return it.

    Call this before play begins: a player should not learn after an hour that nothing is recorded.

    Raises:
        TltlError: TLT0005, the folder is not writable.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with TemporaryFile(dir=folder):
            return folder
    except OSError as error:
        title = f"cannot write to `{folder}`: {fileio.reason(error)}"
        raise TltlError([Diagnostic("TLT0005", title, help="name another folder")]) from None
