"""Processes that are started so that Ctrl-C, which a terminal sends to all of them, is heard by the first one alone."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def interrupts_withheld() -> Iterator[None]:
    """What is started within never hears of Ctrl-C, not even while it imports; this process does, a moment later.

    On Windows it hears of it until it ignores it.
    """
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    # A process begins with the mask of the thread that started it.
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
