"""Start with all three standard streams, whichever of them the caller has closed.

Without this, the next file that is opened gets the number of the closed stream, and what is printed lands in that file.
"""

from __future__ import annotations

import os
import sys
from typing import Final

_MODES: Final = (os.O_RDONLY, os.O_RDONLY, os.O_WRONLY)
"""How the null device is opened in place of standard input, output and error.

Writing to standard output then fails, so that a command whose result is lost says so; messages are lost in silence.
"""


def open_missing_streams() -> None:
    """Open the null device in place of each standard stream that is closed.

    ``sys.stdin`` stays None where standard input is closed: :mod:`tltlc.io.spec_file` reports that where it is read.
    """
    opened = {number: _open(number, mode) for number, mode in enumerate(_MODES) if not _is_open(number)}
    if sys.stdout is None:
        sys.stdout = open(opened.get(1, 1), "w", encoding="utf-8", closefd=False)  # noqa: SIM115
    if sys.stderr is None:
        sys.stderr = open(opened.get(2, 2), "w", encoding="utf-8", closefd=False)  # noqa: SIM115


def _is_open(number: int) -> bool:
    try:
        os.fstat(number)
    except OSError:
        return False
    return True


def _open(number: int, mode: int) -> int:
    """The null device under that number, which child processes inherit, too."""
    opened = os.open(os.devnull, mode)
    if opened != number:
        os.dup2(opened, number)
        os.close(opened)
    os.set_inheritable(number, True)
    return number
