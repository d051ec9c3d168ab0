"""Worker processes on this machine that play the episodes of an evaluation."""

from __future__ import annotations

import atexit
import os
import pickle
import signal
import threading
import time
import traceback
from collections.abc import Callable, Sequence
from concurrent.futures import Future
from contextlib import ExitStack, suppress
from functools import partial
from multiprocessing.connection import Connection
from typing import Final

from tltl_runtime.evaluation.player import EpisodePlayer, EpisodeRequest
from tltl_runtime.evaluation.scheduler import Result, WorkerLostError
from tltl_runtime.support.child_processes import begin_worker, kill_worker, worker_context
from tltlc.api import fileio

_PROCESS_ENDED: Final = "its process ended; if it printed no error, it was perhaps killed because no memory was left"

_TO_END_S: Final = 5.0
"""The seconds that processes have to close their players."""


class WorkerProcess:
    """A process on this machine that plays episodes.

    The process calls ``make`` once, which returns the object that plays the episodes. ``make`` must be
    picklable. ``modules`` are the names of the modules that this object needs; on Linux, a fork server
    imports them once for all workers.

    A ``ProcessPoolExecutor`` would wait for ever for the rest of a result if its process is killed
    while it sends one. Here, the pipe has no other sender, so it closes with the process.
    """

    def __init__(self, make: Callable[[], EpisodePlayer], modules: Sequence[str] = ()) -> None:
        context = worker_context(["tltl_runtime.evaluation.player", *modules])
        self._connection, theirs = context.Pipe()
        self._process = context.Process(target=_serve, args=(make, theirs), name="player of episodes")
        with fileio.block_interrupts():
            self._process.start()
        theirs.close()
        self._playing: Future[Result] | None = None
        self._receiver: threading.Thread | None = None
        # At its exit, Python waits for processes that nobody closed.
        self._kill = partial(kill_worker, self._process)
        atexit.register(self._kill)

    def play(self, request: EpisodeRequest) -> Future[Result]:
        """Start to play an episode; return a future of its result.

        The future raises the exception that the episode raised, or :class:`WorkerLostError` if the
        process ends. The result of the episode before must be there.
        """
        future: Future[Result] = Future()
        self._playing = future
        self._receiver = threading.Thread(target=self._receive, args=(request, future), daemon=True)
        self._receiver.start()
        return future

    def end(self) -> None:
        """Tell the process to close its player and to end, even if it plays an episode."""
        if self._playing is None or self._playing.done():
            self._connection.close()
        else:
            self._process.terminate()
            # A game may go on in spite of that: its worker then waits for the next request.
            self._playing.add_done_callback(lambda _: self._connection.close())

    def wait_until(self, deadline: float) -> None:
        """Wait for the end of the process; kill it at ``deadline``, a time of ``time.monotonic()``."""
        try:
            self._process.join(max(0.0, deadline - time.monotonic()))
        finally:
            self._kill()
        self._process.join(_TO_END_S)
        if self._receiver is not None:
            self._receiver.join(_TO_END_S)
        self._connection.close()
        atexit.unregister(self._kill)

    def close(self) -> None:
        """End the process, even if it plays an episode."""
        self.end()
        self.wait_until(time.monotonic() + _TO_END_S)

    def _receive(self, request: EpisodeRequest, future: Future[Result]) -> None:
        """Send a request, and pass its result or its error on to ``future``."""
        try:
            self._connection.send(request)
            result, error, where = self._connection.recv()
        except (EOFError, OSError):
            future.set_exception(WorkerLostError(_PROCESS_ENDED))
            return
        except Exception as unreadable:
            future.set_exception(unreadable)
            return
        if error is None:
            future.set_result(result)
        else:
            error.__cause__ = _TracebackInWorker(where)
            future.set_exception(error)


def close_all(workers: Sequence[WorkerProcess]) -> None:
    """End all workers at the same time, even those that play."""
    for worker in workers:
        worker.end()
    deadline = time.monotonic() + _TO_END_S
    with ExitStack() as stack:
        for worker in workers:
            stack.callback(worker.wait_until, deadline)


class _TracebackInWorker(Exception):
    """The cause of an error in a worker process; its message is the traceback there."""

    def __str__(self) -> str:
        return f"\n{self.args[0]}"


def _serve(make: Callable[[], EpisodePlayer], connection: Connection) -> None:
    """Play the episodes that arrive at ``connection`` until its other end is closed."""
    begin_worker()
    signal.signal(signal.SIGTERM, _leave)
    if os.name != "nt":
        os.register_at_fork(after_in_child=lambda: signal.signal(signal.SIGTERM, signal.SIG_DFL))
    if os.name != "nt":
        # A program that the game starts would keep the pipe open after the end of this process.
        os.set_inheritable(connection.fileno(), False)
    player: EpisodePlayer | None = None
    try:
        while True:
            request = connection.recv()
            try:
                player = player or make()
                answer = pickle.dumps((player.play(request), None, ""))
            except Exception as error:
                answer = _failure(error)
            connection.send_bytes(answer)
    except (EOFError, OSError):
        if player is not None:
            player.close()
    except _Left:
        signal.signal(signal.SIGTERM, signal.SIG_IGN)
        # A game may not expect its end in the middle of a step. Nobody is interested in what it says to that.
        with suppress(Exception):
            if player is not None:
                player.close()


class _Left(BaseException):
    """The other process has asked this one to leave the episode that it plays."""


def _leave(*_: object) -> None:
    raise _Left


def _failure(error: Exception) -> bytes:
    """Return the message that carries an error to the other process."""
    where = traceback.format_exc()
    try:
        message = pickle.dumps((None, error, where))
        pickle.loads(message)
    except Exception:
        # An exception whose constructor has arguments of its own cannot always be pickled.
        return pickle.dumps((None, RuntimeError(f"{type(error).__name__}: {error}"), where))
    return message
