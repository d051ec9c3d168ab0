"""The context of `multiprocessing` that starts worker processes."""

from __future__ import annotations

import multiprocessing
import sys
from collections.abc import Iterable
from multiprocessing.context import ForkServerContext, SpawnContext


def worker_context(preloaded: Iterable[str]) -> ForkServerContext | SpawnContext:
    """Return the context of :mod:`multiprocessing` that starts workers.

    On Linux it is a fork server, which loads the modules ``preloaded`` once for all workers of this
    process. A call after the first workers have started cannot change the modules any more. In
    general, a forked process may hang, because it inherits the locks of all threads, but not the
    threads. Here, forking is safe: the fork server computes nothing, and OpenBLAS ends its threads
    before a fork. Workers have the environment variables with
    which the fork server started.
    """
    if sys.platform != "linux":
        return multiprocessing.get_context("spawn")
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(list(preloaded))
    return context
