"""Worker processes on this machine that play the episodes of an evaluation."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Callable, Sequence
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import suppress
from multiprocessing.connection import Connection
from typing import Final

from tltl_runtime.evaluation.player import EpisodePlayer, EpisodeRequest
from tltl_runtime.evaluation.scheduler import Result, WorkerLostError
from tltl_runtime.support.child_processes import end_with_parent, worker_context
from tltlc.api import fileio


class WorkerProcess:
    """A process on this machine that plays episodes.

    The process calls ``make`` once, which returns the object that plays the episodes. ``make`` must be
    picklable. ``modules`` are the names of the modules that this object needs; on Linux, a fork server
    imports them once for all workers. Each worker has an executor of its own. So if the process ends,
    it is known which episode was lost.

    The process has one end of a pipe, and ends when the other end, which this object has, is closed. So
    neither Ctrl-C nor the end of a regression test waits for a game that does not answer.
    """

    def __init__(self, make: Callable[[], EpisodePlayer], modules: Sequence[str] = ()) -> None:
        context = worker_context(["tltl_runtime.evaluation.player", *modules])
        leash, self._leash = context.Pipe(duplex=False)
        self._playing: Future[Result] | None = None
        self._executor = ProcessPoolExecutor(1, context, initializer=_begin, initargs=(make, leash))

    def play(self, request: EpisodeRequest) -> Future[Result]:
        """Start to play an episode; return a future of its result.

        The future raises the exception that the episode raised, or :class:`WorkerLostError` if the
        process ends.
        """
        future: Future[Result] = Future()
        self._playing = future
        try:
            with fileio.block_interrupts():
                playing = self._executor.submit(_play, request)
            playing.add_done_callback(lambda done: _pass_on(done, future))
        except BrokenProcessPool:
            future.set_exception(WorkerLostError(_PROCESS_ENDED))
        return future

    def close(self) -> None:
        """End the process, even if it plays an episode."""
        if self._playing is not None and not self._playing.done():
            self._leash.close()
        # Wait: an executor that is still shutting down when Python exits may fail or hang.
        self._executor.shutdown(wait=True, cancel_futures=True)
        self._leash.close()


_PROCESS_ENDED: Final = "its process ended; if it printed no error, it was perhaps killed because no memory was left"

_make: Callable[[], EpisodePlayer]
_player: EpisodePlayer | None = None
"""The object with which this worker process plays episodes; None before the first episode."""


def _begin(make: Callable[[], EpisodePlayer], leash: Connection) -> None:
    global _make
    # The parent process handles Ctrl-C.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    end_with_parent()
    threading.Thread(target=_end_with, args=(leash,), name="end with the pipe", daemon=True).start()
    _make = make


def _end_with(leash: Connection) -> None:
    """End this process when the other end of a pipe is closed."""
    with suppress(EOFError, OSError):
        leash.recv_bytes()
    os._exit(1)


def _play(request: EpisodeRequest) -> Result:
    # The player is made here because an exception in `_begin` would be lost.
    global _player
    _player = _player or _make()
    return _player.play(request)


def _pass_on(done: Future[Result], future: Future[Result]) -> None:
    error = done.exception()
    if isinstance(error, BrokenProcessPool):
        future.set_exception(WorkerLostError(_PROCESS_ENDED))
    elif error is not None:
        future.set_exception(error)
    else:
        future.set_result(done.result())
