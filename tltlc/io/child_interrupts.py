"""Treat an interrupt of a child process as an interrupt of this process.

Ctrl-C in a terminal reaches both processes, and the child may end first. Without this module, the
exit status of the child would look like a failure.
"""

from __future__ import annotations

import signal
from typing import Final

_SIGNALS: Final = tuple(getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name))
_BY_STATUS: Final = {
    **{-number: number for number in _SIGNALS},
    130: signal.SIGINT,
    143: signal.SIGTERM,
    0xC000013A: signal.SIGINT,
}
"""Maps exit statuses to signals.

The negative statuses are those of :mod:`subprocess`, 130 and 143 those of shells, and the last one
that of Windows. 129, a shell's status for SIGHUP, is left out, because git uses 129 for errors.
"""


def raise_if_interrupted(returncode: int) -> None:
    """Raise KeyboardInterrupt if SIGINT, SIGTERM or SIGHUP has ended a child process.

    If this process has a handler for the signal, the handler runs first. It can then end this
    process with the exit status for the signal.
    """
    number = _BY_STATUS.get(returncode)
    if number is None:
        return
    if callable(signal.getsignal(number)):
        signal.raise_signal(number)
    raise KeyboardInterrupt
