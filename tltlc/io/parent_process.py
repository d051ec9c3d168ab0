"""End a child process when the process that started it ends, even if that process is killed."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading


def end_with_parent() -> None:
    """End this process of :mod:`multiprocessing` as soon as its parent ends, whatever it is doing."""
    threading.Thread(target=_end_after_parent, daemon=True).start()


def terminate_with_input() -> None:
    """Send SIGTERM to this process when its standard input ends.

    The parent must hold the other end of standard input. On Windows, the process ends at once.
    """
    threading.Thread(target=_terminate_after_input, daemon=True).start()


def _end_after_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(0)


def _terminate_after_input() -> None:
    while os.read(0, 1 << 16):
        pass
    os.kill(os.getpid(), signal.SIGTERM)
