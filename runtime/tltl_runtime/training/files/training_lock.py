"""Lock the folder of a training for one process."""

from __future__ import annotations

from contextlib import AbstractContextManager
from pathlib import Path

from tltl_runtime.support.folder_lock import lock_folder
from tltl_runtime.training.files.run_file import WRITABLE
from tltlc.api import Diagnostic


def lock_training(folder: Path) -> AbstractContextManager[None]:
    """Return a context manager that locks ``folder``, so that no other process trains in it.

    Entering the context creates the folder if it is missing, and raises the errors below.

    Raises:
        TltlError: TLT0005, the folder cannot be written to; TLT0865, another process trains in it.
    """
    title = f"another process is training in `{folder}`"
    busy = Diagnostic(
        "TLT0865", title, help="wait until it ends; for a new training, you can name another folder with --out"
    )
    return lock_folder(folder, busy, WRITABLE)
