"""Judge many traces at once, in worker processes."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Generator, Iterator, Mapping, Sequence
from contextlib import suppress
from multiprocessing import get_context, resource_tracker
from multiprocessing.connection import Connection, wait
from multiprocessing.context import SpawnProcess
from threading import Thread
from typing import Final

from tltlc.automaton.fspa import Fspa
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.io.child_interrupts import block_interrupts
from tltlc.io.files import read_bytes
from tltlc.io.limits import JUDGED_TRACE
from tltlc.monitor.packed import unpacked
from tltlc.tools.judge.clauses import Clauses
from tltlc.tools.judge.judge import Judge
from tltlc.tools.judge.verdict import JudgedTrace

_FEW: Final = 40
"""By default, there are no worker processes for fewer traces than this: starting them would take longer."""

_CHUNK: Final = 8
"""A worker gets at most this many traces at a time."""

_MOST_WORKERS: Final = 60
"""The most worker processes. Windows can wait for at most 63 processes at once."""

_PARENT_CHECK_S: Final = 0.5
"""How many seconds a worker waits before it checks again whether its parent still runs."""


def judge_files(
    fspa: Fspa,
    clauses: Clauses,
    paths: Sequence[str],
    workers: int | None = None,
    *,
    episodes: bool = False,
    details: bool = False,
    sparse: bool = False,
) -> Generator[JudgedTrace]:
    """Judge the traces in these files, and yield the results in the order of ``paths``.

    ``workers`` is the number of worker processes. With 1, this process judges the traces itself.
    The default is one worker for each core, but 1 for fewer than ``_FEW`` traces. ``episodes``,
    ``details`` and ``sparse`` are as for :class:`~tltlc.tools.judge.judge.Judge`. Closing the iterator ends the
    workers. A file that cannot be read gets a result without a verdict.

    Raises:
        TltlError: TLT0007, a worker ended before its traces were judged.
    """
    if workers is None:
        workers = _cores() if len(paths) >= _FEW else 1
    workers = min(workers, len(paths), _MOST_WORKERS)
    options = {"episodes": episodes, "details": details, "sparse": sparse}
    if workers > 1:
        yield from _judge_in_workers(paths, workers, fspa, clauses, **options)
        return
    judge = Judge(fspa, clauses, **options)
    for path in paths:
        yield _judge_file(judge, path)


def _cores() -> int:
    """Return the number of CPU cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _judge_file(judge: Judge, path: str) -> JudgedTrace:
    try:
        data = read_bytes(path, path, JUDGED_TRACE.size)
        if len(data) <= JUDGED_TRACE.size:
            # The limits are those of the text in memory, and a small packed file may have a very long one.
            data = unpacked(data, path)
        assert JUDGED_TRACE.values is not None
        if len(data) > JUDGED_TRACE.size or data.count(b"\n") > JUDGED_TRACE.values:
            title = f"`{path}` is larger than {JUDGED_TRACE.size >> 20} MiB or {JUDGED_TRACE.values:,} samples"
            help_ = "judge it alone: `tltlc monitor SPEC TRACE` reads a trace of any size, row by row"
            raise TltlError([Diagnostic("TLT0004", title, help=help_)])
    except TltlError as error:
        return JudgedTrace(path, None, error.diagnostics)
    return judge.judge(path, data)


def _judge_in_workers(
    paths: Sequence[str], workers: int, fspa: Fspa, clauses: Clauses, **options: bool
) -> Iterator[JudgedTrace]:
    size = max(1, min(_CHUNK, len(paths) // workers))
    chunks = iter([(start, paths[start : start + size]) for start in range(0, len(paths), size)])
    started: list[_Worker] = []
    judged: dict[int, JudgedTrace] = {}
    following = 0
    try:
        # Python's resource tracker, which the first worker would start, would allow interrupts again.
        resource_tracker.ensure_running()
        with block_interrupts():
            # This keeps the workers that have started before an error.
            started.extend(_Worker(fspa, clauses, options) for _ in range(workers))
        for worker in started:
            worker.give(next(chunks, None))
        while following < len(paths):
            for connection in wait([worker.connection for worker in started if worker.is_busy]):
                worker = next(worker for worker in started if worker.connection is connection)
                judged.update(enumerate(worker.take(), worker.start))
                worker.give(next(chunks, None))
            while following in judged:
                yield judged.pop(following)
                following += 1
    finally:
        for worker in started:
            worker.end()


class _Worker:
    """A process that judges traces, one chunk (a list of paths) after the other.

    ``start`` is the index of the first trace of the current chunk. ``is_busy`` is true while the
    process has a chunk.
    """

    def __init__(self, fspa: Fspa, clauses: Clauses, options: Mapping[str, bool]) -> None:
        # A forked worker would inherit the locks of threads that other code of this process has started.
        context = get_context("spawn")
        self.connection, child = context.Pipe()
        self._process: SpawnProcess = context.Process(target=_work, args=(child, os.getpid()), daemon=True)
        self._process.start()
        child.close()
        self.start = 0
        self.is_busy = False
        # A large spec among the arguments would block the start for ever if the process is killed meanwhile.
        self._send((fspa, clauses, dict(options)))

    def give(self, chunk: tuple[int, Sequence[str]] | None) -> None:
        """Send the worker its next chunk; for None, there are no more chunks, so send nothing.

        A chunk is the index of its first trace, and the paths of all of its traces. Raises TltlError,
        TLT0007, if the process has ended.
        """
        self.is_busy = chunk is not None
        if chunk is not None:
            self.start = chunk[0]
            self._send(chunk[1])

    def _send(self, message: object) -> None:
        try:
            self.connection.send(message)
        except OSError:
            raise _lost_error() from None

    def take(self) -> Sequence[JudgedTrace]:
        """Wait for the results for the current chunk, and return them.

        Raises TltlError, TLT0007, if the process has ended.
        """
        try:
            results: Sequence[JudgedTrace] = self.connection.recv()
        except (EOFError, OSError):
            raise _lost_error() from None
        return results

    def end(self) -> None:
        """End the process at once, even if it still reads a file."""
        self._process.kill()
        self._process.join()
        self.connection.close()


def _lost_error() -> TltlError:
    title = "a process that judged traces ended unexpectedly"
    return TltlError([Diagnostic("TLT0007", title, help="judge them one after the other: `--workers 1`")])


# --- in a worker ----------------------------------------------------------------------------------


def _work(connection: Connection, parent: int) -> None:
    """Judge traces in a worker process until the connection is closed.

    The first message on the connection has the arguments of a
    :class:`~tltlc.tools.judge.judge.Judge`. Each further message is a list of paths, and is answered
    with a list of results. ``parent`` is the id of the parent process; the worker ends with it.
    """
    # Only the parent handles Ctrl-C, and a worker must not outlive it.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    Thread(target=_exit_with_parent, args=(parent,), daemon=True).start()
    with suppress(EOFError, OSError):
        fspa, clauses, options = connection.recv()
        judge = Judge(fspa, clauses, **options)
        while True:
            paths: Sequence[str] = connection.recv()
            connection.send([_judge_file(judge, path) for path in paths])


def _exit_with_parent(parent: int) -> None:
    while os.getppid() == parent:
        time.sleep(_PARENT_CHECK_S)
    os._exit(1)
