"""Treat the interrupt of a child process as one of this process: Ctrl-C in a terminal reaches both.

The child may end first. Its exit status would then look like a fault of the child.
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
"""Signals by the exit statuses of :mod:`subprocess`, of shells, and of Windows; git uses 129, SIGHUP's, itself."""


def raise_if_interrupted(returncode: int) -> None:
    """Raise KeyboardInterrupt if a child process has ended by SIGINT, SIGTERM or SIGHUP.

    This process handles that signal first, if it has a handler for it, so that its exit status is that of the signal.
    """
    number = _BY_STATUS.get(returncode)
    if number is None:
        return
    if callable(signal.getsignal(number)):
        signal.raise_signal(number)
    raise KeyboardInterrupt
