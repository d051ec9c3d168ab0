"""Handle Ctrl-C, which a terminal sends to this process and to its child processes.

Some children should not receive Ctrl-C, so that only this process handles it
(:func:`block_interrupts`). Other children receive it, and may end before this process handles it.
The exit status of such a child must count as an interrupt of this process, not as a failure
(:func:`raise_if_interrupted`).
"""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final

_SIGNALS: Final = tuple(getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name))
_BY_STATUS: Final = {
    **{-number: number for number in _SIGNALS},
    130: signal.SIGINT,
    143: signal.SIGTERM,
    0xC000013A: signal.SIGINT,
}
"""Maps exit statuses to signals.

The negative statuses are those of :mod:`subprocess`, 130 and 143 are those of shells, and the last
one is that of Windows. 129, a shell's status for SIGHUP, is left out, because git uses 129 for errors.
"""


def raise_if_interrupted(returncode: int) -> None:
    """Raise KeyboardInterrupt if SIGINT, SIGTERM or SIGHUP has ended a child process.

    ``returncode`` is the exit status of the child. If this process has a handler for the signal,
    the handler runs first, and may end this process with the exit status for the signal.
    """
    number = _BY_STATUS.get(returncode)
    if number is None:
        return
    if callable(signal.getsignal(number)):
        signal.raise_signal(number)
    raise KeyboardInterrupt


@contextmanager
def block_interrupts() -> Iterator[None]:
    """Block SIGINT inside the ``with`` block, and in all processes that are started there.

    A process started there keeps SIGINT blocked after the block, too. If SIGINT is sent to this
    process during the block, it arrives at the end of the block. Windows has no signal masks:
    there, a child receives Ctrl-C until it ignores SIGINT itself.
    """
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    # A child process inherits the signal mask of the thread that starts it.
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
