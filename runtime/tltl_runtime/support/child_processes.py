"""Start child processes with SIGINT blocked, so that only the parent handles Ctrl-C."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def interrupts_withheld() -> Iterator[None]:
    """Block SIGINT in processes started within this context, even while they import; this process
    receives it afterwards.

    Windows has no signal masks: there, a child receives Ctrl-C until it ignores it itself.
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
