"""Start child processes with SIGINT blocked, so that only the parent handles Ctrl-C."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def block_interrupts() -> Iterator[None]:
    """Block SIGINT within this context, and in all processes that are started there.

    A child process keeps SIGINT blocked, even while it imports its modules. This process receives a
    pending SIGINT at the end of the context. Windows has no signal masks: there, a child receives
    Ctrl-C until it ignores SIGINT itself.
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
