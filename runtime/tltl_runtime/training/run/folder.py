"""The folder of a training, which belongs to one process at a time."""

from __future__ import annotations

from contextlib import AbstractContextManager
from pathlib import Path

from tltl_runtime.support import folder_lock as held_folder
from tltl_runtime.training.run.run import WRITABLE
from tltlc.diagnostics.diagnostic import Diagnostic


def held(folder: Path) -> AbstractContextManager[None]:
    """Within, no other process trains in the folder, which is made where it is missing.

    Raises:
        TltlError: TLT0005, nothing can be written there; TLT0865, another process trains there.
    """
    title = f"another process trains in `{folder}`"
    busy = Diagnostic("TLT0865", title, help="wait for its end; a new training may go elsewhere, with --out")
    return held_folder.held(folder, busy, WRITABLE)
