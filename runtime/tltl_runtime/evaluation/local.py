"""Workers of this machine."""

from __future__ import annotations

import multiprocessing
import os
import signal
import sys
import threading
from collections.abc import Callable
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from multiprocessing.context import BaseContext
from typing import Final

from tltl_runtime.evaluation.player import Plays, Result, Task
from tltl_runtime.evaluation.spread import LostError
from tltl_runtime.support.child_processes import interrupts_withheld


class Process:
    """A process of its own, an executor's only one: where it breaks, it is known what it was playing.

    Who plays there is what ``make`` makes there, which can be pickled.
    """

    def __init__(self, make: Callable[[], Plays]) -> None:
        self._executor = ProcessPoolExecutor(1, _context(), initializer=_begin, initargs=(make,))

    def play(self, task: Task) -> Future[Result]:
        """Begin an episode."""
        future: Future[Result] = Future()
        try:
            with interrupts_withheld():
                playing = self._executor.submit(_play, task)
            playing.add_done_callback(lambda done: _pass_on(done, future))
        except BrokenProcessPool:
            future.set_exception(LostError(_ENDED))
        return future

    def close(self) -> None:
        """Wait until the process has played its episode, and end it; others play theirs meanwhile."""
        # An executor that still ends when Python does may fail, or never end.
        self._executor.shutdown(wait=True, cancel_futures=True)


def _context() -> BaseContext:
    """How processes are started: on Linux as copies of one that has loaded torch, once for all of them.

    A copy has the locks of all threads, and not the threads: that process computes nothing, so torch has none there,
    and OpenBLAS ends its own before a copy is made.
    """
    if sys.platform != "linux":
        return multiprocessing.get_context("spawn")
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(["tltl_runtime.evaluation.player"])
    return context


_ENDED: Final = "its process ended; where it said nothing before, it was perhaps killed for want of memory"

_make: Callable[[], Plays]
_player: Plays | None = None
"""Of a process that plays."""


def _begin(make: Callable[[], Plays]) -> None:
    global _make
    # Whoever started this one decides what Ctrl-C means.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()
    _make = make


def _end_with_parent() -> None:
    """An executor's process would wait for ever for the next task of a parent that was killed."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
    os._exit(1)


def _play(task: Task) -> Result:
    # What is raised in `_begin` would be lost, and here it is told.
    global _player
    _player = _player or _make()
    return _player.play(task)


def _pass_on(done: Future[Result], future: Future[Result]) -> None:
    error = done.exception()
    if isinstance(error, BrokenProcessPool):
        future.set_exception(LostError(_ENDED))
    elif error is not None:
        future.set_exception(error)
    else:
        future.set_result(done.result())
