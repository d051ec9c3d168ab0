"""Make sure that all three standard streams are open, even if the caller closed some of them.

Otherwise, the next file that is opened gets the number of the closed stream, and printed text ends
up in that file.
"""

from __future__ import annotations

import os
import sys
from typing import Final

_MODES: Final = (os.O_RDONLY, os.O_RDONLY, os.O_WRONLY)
"""How the null device is opened in place of standard input, output and error.

Standard output is opened for reading, so writing to it fails and a command whose result would be
lost reports an error. Messages to standard error are lost silently.
"""


def open_missing_streams() -> None:
    """Open the null device in place of each standard stream that is closed.

    If standard input is closed, ``sys.stdin`` stays None; :mod:`tltlc.io.spec_file` reports that on
    reading.
    """
    null_streams = {number: _open(number, mode) for number, mode in enumerate(_MODES) if not _is_open(number)}
    if sys.stdout is None:
        sys.stdout = open(null_streams.get(1, 1), "w", encoding="utf-8", closefd=False)  # noqa: SIM115
    if sys.stderr is None:
        sys.stderr = open(null_streams.get(2, 2), "w", encoding="utf-8", closefd=False)  # noqa: SIM115


def _is_open(number: int) -> bool:
    try:
        os.fstat(number)
    except OSError:
        return False
    return True


def _open(number: int, mode: int) -> int:
    """Open the null device as file descriptor ``number``. Child processes inherit it."""
    descriptor = os.open(os.devnull, mode)
    if descriptor != number:
        os.dup2(descriptor, number)
        os.close(descriptor)
    os.set_inheritable(number, True)
    return number
