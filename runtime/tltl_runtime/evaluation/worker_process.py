"""Worker processes on this machine that play the episodes of an evaluation."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
from collections.abc import Callable, Sequence
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from typing import Final

from tltl_runtime.evaluation.player import EpisodePlayer, EpisodeRequest, PlayedEpisode
from tltl_runtime.evaluation.scheduler import WorkerLostError
from tltl_runtime.support.child_processes import worker_context
from tltlc.api import fileio


class WorkerProcess:
    """A process on this machine that plays episodes.

    The process calls ``make`` once, which returns the object that plays the episodes. ``make`` must be
    picklable. ``modules`` are the names of the modules that this object needs; on Linux, a fork server
    imports them once for all workers. Each worker has an executor of its own. So if the process ends,
    it is known which episode was lost.
    """

    def __init__(self, make: Callable[[], EpisodePlayer], modules: Sequence[str] = ()) -> None:
        context = worker_context(["tltl_runtime.evaluation.player", *modules])
        self._executor = ProcessPoolExecutor(1, context, initializer=_begin, initargs=(make,))

    def play(self, request: EpisodeRequest) -> Future[PlayedEpisode]:
        """Start to play an episode; return a future of its result.

        The future raises the exception that the episode raised, or :class:`WorkerLostError` if the
        process ends.
        """
        future: Future[PlayedEpisode] = Future()
        try:
            with fileio.block_interrupts():
                playing = self._executor.submit(_play, request)
            playing.add_done_callback(lambda done: _pass_on(done, future))
        except BrokenProcessPool:
            future.set_exception(WorkerLostError(_PROCESS_ENDED))
        return future

    def close(self) -> None:
        """Wait until the process has played its current episode, then end the process."""
        # Wait: an executor that is still shutting down when Python exits may fail or hang.
        self._executor.shutdown(wait=True, cancel_futures=True)


_PROCESS_ENDED: Final = "its process ended; if it printed no error, it was perhaps killed because no memory was left"

_make: Callable[[], EpisodePlayer]
_player: EpisodePlayer | None = None
"""The object with which this worker process plays episodes; None before the first episode."""


def _begin(make: Callable[[], EpisodePlayer]) -> None:
    global _make
    # The parent process handles Ctrl-C.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()
    _make = make


def _end_with_parent() -> None:
    """Wait until the parent process has ended, then end this process.

    Without this, a worker would wait forever if its parent is killed.
    """
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
    os._exit(1)


def _play(request: EpisodeRequest) -> PlayedEpisode:
    # The player is made here because an exception in `_begin` would be lost.
    global _player
    _player = _player or _make()
    return _player.play(request)


def _pass_on(done: Future[PlayedEpisode], future: Future[PlayedEpisode]) -> None:
    error = done.exception()
    if isinstance(error, BrokenProcessPool):
        future.set_exception(WorkerLostError(_PROCESS_ENDED))
    elif error is not None:
        future.set_exception(error)
    else:
        future.set_result(done.result())
