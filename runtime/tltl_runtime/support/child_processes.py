"""The :mod:`multiprocessing` context that starts worker processes."""

from __future__ import annotations

import multiprocessing
import os
import sys
import threading
from collections.abc import Iterable
from multiprocessing import resource_tracker
from multiprocessing.context import ForkServerContext, SpawnContext


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


def end_with_parent() -> None:
    """End this process, a worker, as soon as its parent process has ended.

    Without this, a worker whose parent is killed would wait for ever for the next command, or play on
    with a game that does not answer.
    """
    threading.Thread(target=_end_with_parent, name="end with the parent process", daemon=True).start()


def _end_with_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)
