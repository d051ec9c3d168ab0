"""How worker processes start, and how to start them with SIGINT blocked, so that only the parent handles Ctrl-C."""

from __future__ import annotations

import multiprocessing
import signal
import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from multiprocessing.context import ForkServerContext, SpawnContext


def worker_context(preloaded: Iterable[str]) -> ForkServerContext | SpawnContext:
    """Return the context of :mod:`multiprocessing` that starts workers.

    On Linux it is a fork server, which loads the modules ``preloaded`` once for all workers of this
    process. A call after the first workers have started cannot change the modules any more. In
    general, a forked process may hang, because it inherits the locks of all threads, but not the
    threads. Here, forking is safe: the fork server computes nothing, so torch starts no threads in
    it, and OpenBLAS ends its threads before a fork. Workers have the environment variables with
    which the fork server started.
    """
    if sys.platform != "linux":
        return multiprocessing.get_context("spawn")
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(list(preloaded))
    return context


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
