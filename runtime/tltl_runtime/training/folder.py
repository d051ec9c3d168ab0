"""The folder of a training, which belongs to one process at a time."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Final

from tltl_runtime.training.run import WRITABLE
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.files import reason

_LOCK: Final = ".lock"


@contextmanager
def held(folder: Path) -> Iterator[None]:
    """Within, no other process trains in the folder, which is made where it is missing.

    The system lets go of it when the process ends, however it does.

    Raises:
        TltlError: TLT0005, nothing can be written there; TLT0865, another process trains there.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        file = (folder / _LOCK).open("a+b")
    except (OSError, ValueError) as error:
        title = f"cannot write into `{folder}`: {reason(error)}"
        raise TltlError([Diagnostic("TLT0005", title, help=WRITABLE)]) from None
    with file:
        if not _locked(file):
            title = f"another process trains in `{folder}`"
            help_ = "wait for its end; a new training may go elsewhere, with --out"
            raise TltlError([Diagnostic("TLT0865", title, help=help_)])
        yield


def _locked(file: IO[bytes]) -> bool:
    """Lock the file, until it is closed; False where another process has."""
    try:
        import fcntl
    except ModuleNotFoundError:  # Windows
        import msvcrt

        try:
            msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)  # type: ignore[attr-defined,unused-ignore]
        except OSError:
            return False
        return True
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True
