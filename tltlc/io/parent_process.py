"""End a child process when the process that started it ends, even if that process is killed."""

from __future__ import annotations

import multiprocessing
import os
import signal
import sys
import threading
import time


def end_with_parent() -> None:
    """End this process of :mod:`multiprocessing` as soon as its parent ends, whatever it is doing."""
    threading.Thread(target=_end_after_parent, daemon=True).start()


def terminate_with_input(patience_s: float) -> None:
    """Send SIGTERM to this process when its standard input ends, and kill it ``patience_s`` seconds later.

    The parent must hold the other end of standard input. If this process leads a process group, the
    whole group is killed. On Windows, the process ends at once.
    """
    threading.Thread(target=_terminate_after_input, args=(patience_s,), daemon=True).start()


def _end_after_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(0)


def _terminate_after_input(patience_s: float) -> None:
    while os.read(0, 1 << 16):
        pass
    os.kill(os.getpid(), signal.SIGTERM)
    if sys.platform != "win32":
        # Python loses no signal, but a system call that begins just after one blocks before Python handles it.
        time.sleep(patience_s)
        kill = os.killpg if os.getpgrp() == os.getpid() else os.kill
        kill(os.getpid(), signal.SIGKILL)
