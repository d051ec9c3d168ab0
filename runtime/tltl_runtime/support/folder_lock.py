"""Lock a folder for one process at a time."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Final

from tltlc.api import Diagnostic, TltlError, fileio

_LOCK: Final = ".lock"


@contextmanager
def lock_folder(folder: Path, busy: Diagnostic, advice: str) -> Iterator[None]:
    """Lock a folder inside the ``with`` block; create the folder if it is missing.

    The operating system releases the lock when the process ends, even after a crash.

    Raises:
        TltlError: TLT0005, with ``advice`` as its help, if the folder is not writable; the
            diagnostic ``busy`` if another process has the lock.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        file = (folder / _LOCK).open("a+b")
    except (OSError, ValueError) as error:
        title = f"cannot write into `{folder}`: {fileio.reason(error)}"
        raise TltlError([Diagnostic("TLT0005", title, help=advice)]) from None
    with file:
        if not fileio.try_lock(file):
            raise TltlError([busy])
        yield
