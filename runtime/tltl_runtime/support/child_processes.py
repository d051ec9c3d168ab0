"""Worker processes: the :mod:`multiprocessing` context that starts them, their beginning and their end."""

from __future__ import annotations

import multiprocessing
import os
import signal
import sys
import threading
from collections.abc import Iterable
from contextlib import suppress
from multiprocessing import resource_tracker
from multiprocessing.context import ForkServerContext, SpawnContext
from multiprocessing.process import BaseProcess
from typing import NoReturn


def worker_context(preloaded: Iterable[str]) -> ForkServerContext | SpawnContext:
    """Return the :mod:`multiprocessing` context with which this process starts workers.

    On Linux, a fork server starts the workers. It loads the modules ``preloaded`` once for all of
    them; calls after the first worker has started cannot change these modules any more. Workers
    have the environment variables with which the fork server started. On other systems, each worker
    is spawned, and ``preloaded`` is not used.

    In general, a forked process may hang, because it inherits the locks of all threads, but not the
    threads. Here, forking is safe: the fork server computes nothing, and OpenBLAS ends its threads
    before a fork.
    """
    if sys.platform != "linux":
        return multiprocessing.get_context("spawn")
    # The first start of a worker would start this, too, and leave SIGINT unblocked (`fileio.block_interrupts`).
    resource_tracker.ensure_running()
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(list(preloaded))
    return context


def begin_worker() -> None:
    """Prepare this process, a worker: Ctrl-C is left to its parent, and it ends as soon as its parent has ended.

    Without this, a worker whose parent is killed would wait for ever for the next command, or play on
    with a game that does not answer. On Unix, the worker leads a process group of its own. The programs that
    its games start belong to the group and end with it, unless they begin a session of their own.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if os.name != "nt":
        os.setpgid(0, 0)
        # A terminal may stop a process that is not of its foreground group and prints.
        signal.signal(signal.SIGTTOU, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, name="end with the parent process", daemon=True).start()


def end_worker() -> NoReturn:
    """End this process, a worker, and on Unix the programs that it has started."""
    if os.name != "nt":
        os.killpg(0, signal.SIGKILL)
    os._exit(1)


def kill_worker(process: BaseProcess) -> None:
    """Kill a worker, if it still runs, and on Unix the programs that it has started and not ended."""
    if os.name != "nt" and process.pid is not None and not _has_new_owner(process):
        # There is no such group if the worker has not begun, or if it has ended and left no process.
        with suppress(OSError):
            os.killpg(process.pid, signal.SIGKILL)
    process.kill()


def _has_new_owner(process: BaseProcess) -> bool:
    """Whether the worker has ended, and another process has its id. No process of the worker is left then."""
    if process.exitcode is None or process.pid is None:
        return False
    try:
        os.getpgid(process.pid)
    except ProcessLookupError:
        return False
    return True


def _end_with_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        end_worker()
