"""Worker processes as seen by the process that uses them: start, command, watch and stop them."""

from __future__ import annotations

import contextlib
import selectors
import time
from collections.abc import Callable, Iterator, Sequence
from multiprocessing.connection import Connection
from multiprocessing.context import ForkServerContext, ForkServerProcess, SpawnContext, SpawnProcess
from typing import Any, Final

from gymnasium.vector import AutoresetMode
from gymnasium.vector.utils import CloudpickleWrapper

from tltl_runtime.support.child_processes import kill_worker
from tltl_runtime.vector.errors import Loss
from tltl_runtime.vector.shared_memory import Rows
from tltl_runtime.vector.worker import CLOSE, FAILED, EnvFunction, work
from tltlc.api import Diagnostic, fileio, replace

TO_START_S: Final = 120.0
"""The seconds that a worker has to import its modules and make its environments.

If the ``timeout`` of the workers is longer, that time counts instead.
"""
_TO_END_S: Final = 5.0
"""The seconds that a worker may take to end after a command to close, or after it was killed."""

_REPORT_S: Final = 1.0
"""The seconds between two looks at how many environments are made."""


class Workers:
    """Processes that step environments.

    ``shares`` has a slice for each worker: the indices of the environments that it steps. A worker is
    lost if its process ends, if an environment raises, or if it is silent for ``timeout`` seconds. Its
    answer is then a :class:`Loss`, and :meth:`start` can start a new process in its place.

    No worker is forked from this process: forking while threads of torch or OpenBLAS exist is unsafe
    (:func:`~tltl_runtime.support.child_processes.worker_context`).
    """

    def __init__(
        self,
        context: ForkServerContext | SpawnContext,
        functions: Sequence[EnvFunction],
        shares: Sequence[slice],
        rows: Rows,
        autoreset: AutoresetMode,
        timeout: float,
    ) -> None:
        self.shares = tuple(shares)
        self._context, self._functions, self._rows = context, functions, rows
        self._autoreset, self._timeout = autoreset, timeout
        self._processes: dict[int, ForkServerProcess | SpawnProcess] = {}
        self._connections: dict[int, Connection] = {}
        self._pending: set[int] = set()
        """Workers whose answers are pending; the selector watches only these."""
        self._selector = selectors.DefaultSelector()

    @property
    def is_waiting(self) -> bool:
        """Whether an answer is pending, for example after a Ctrl-C during a command."""
        return bool(self._pending)

    def pid(self, worker: int) -> int | None:
        """Return the process id of a worker."""
        return self._processes[worker].pid

    def start(self, workers: Sequence[int], on_made: Callable[[int], None] | None = None) -> list[Loss]:
        """Start the workers with these indices, and wait until they have made their environments.

        While some are still made, ``on_made`` is called with the number of environments that are made,
        each time that it has grown, about once a second. Return a :class:`Loss` for each worker that was
        lost while it started.
        """
        for worker in workers:
            ours, theirs = self._context.Pipe()
            share = self.shares[worker]
            functions = CloudpickleWrapper(self._functions[share])  # type: ignore[arg-type]
            process = self._context.Process(
                target=work,
                args=(theirs, functions, self._rows, share.start, self._autoreset),
                name=f"env worker {worker}",
                daemon=True,
            )
            with fileio.block_interrupts():
                process.start()
            theirs.close()
            self._processes[worker], self._connections[worker] = process, ours
            self._watch(worker)
        patience = max(self._timeout, TO_START_S)
        return [
            replace(answer, starting=True) for answer in self.answers(patience, on_made) if isinstance(answer, Loss)
        ]

    def ask(self, command: str, arguments: Sequence[tuple[Any, ...]]) -> list[Any]:
        """Send a command to all workers, each with its own arguments; return their answers in order.

        The answer of a lost worker is a :class:`Loss`.
        """
        for worker, worker_arguments in enumerate(arguments):
            self.send(worker, command, worker_arguments)
        return self.answers()

    def send(self, worker: int, command: str, arguments: tuple[Any, ...]) -> None:
        """Send a command to one worker; :meth:`answers` returns its answer."""
        self._watch(worker)
        # If the other end is gone, the answer will be the loss.
        with contextlib.suppress(BrokenPipeError, ConnectionResetError):
            self._connections[worker].send((command, arguments))

    def answers(self, patience: float | None = None, on_made: Callable[[int], None] | None = None) -> list[Any]:
        """Wait for the pending answers, and return them in the order of the workers.

        A worker that does not answer within ``patience`` seconds, by default ``timeout``, is killed.
        The answer of a lost worker is a :class:`Loss`. ``on_made`` is that of :meth:`start`.
        """
        patience = self._timeout if patience is None else patience
        deadline = time.monotonic() + patience
        answers: dict[int, Any] = {}
        made = 0
        while self._pending:
            ready = self._ready(deadline if on_made is None else min(deadline, time.monotonic() + _REPORT_S))
            if on_made and (count := int(self._rows.made.sum())) > made:
                made = count
                on_made(made)
            if not ready and time.monotonic() < deadline:
                continue
            for worker in ready or tuple(self._pending):
                answers[worker] = self._answer(worker) if ready else self._end_lost(worker, silent=patience)
        return [answers[worker] for worker in sorted(answers)]

    def close(self) -> None:
        """End all workers; those that do not end in time are killed."""
        for connection in self._connections.values():
            with contextlib.suppress(OSError):
                connection.send((CLOSE, ()))
        deadline = time.monotonic() + _TO_END_S
        for worker in list(self._processes):
            self._processes[worker].join(max(0.0, deadline - time.monotonic()))
            self._end(worker)
        self._pending.clear()
        self._selector.close()

    def _watch(self, worker: int) -> None:
        """Register a worker, so that :meth:`_ready` notices its answer or its end."""
        self._pending.add(worker)
        for file in (self._connections[worker].fileno(), self._processes[worker].sentinel):
            self._selector.register(file, selectors.EVENT_READ, worker)

    def _unwatch(self, worker: int) -> None:
        for file in (self._connections[worker].fileno(), self._processes[worker].sentinel):
            # Only one file is registered if a Ctrl-C came between the registrations, and none if the worker is idle.
            with contextlib.suppress(KeyError):
                self._selector.unregister(file)
        self._pending.discard(worker)

    def _ready(self, deadline: float) -> set[int]:
        """Wait until a worker with a pending answer has answered or ended; return all such workers.

        The set is empty if there is none before ``deadline``, a time of ``time.monotonic()``.
        """
        left = max(0.0, deadline - time.monotonic())
        return {key.data for key, _ in self._selector.select(left)}

    def _answer(self, worker: int) -> Any:
        connection = self._connections[worker]
        try:
            # A worker that has ended may have sent a last answer.
            if connection.poll():
                outcome, answer = connection.recv()
                self._unwatch(worker)
                return self._end_lost(worker, failure=answer) if outcome == FAILED else answer
        except (EOFError, OSError):
            pass
        return self._end_lost(worker)

    def _end_lost(
        self, worker: int, *, silent: float | None = None, failure: tuple[str, tuple[Diagnostic, ...]] = ("", ())
    ) -> Loss:
        """End a lost worker, and return how it was lost.

        ``silent`` is the number of seconds for which it was silent; None if it ended by itself.
        ``failure`` has the traceback and the diagnostics of the exception that ended it.
        """
        process = self._processes[worker]
        if silent is None:
            process.join(_TO_END_S)
        status = process.exitcode
        self._end(worker)
        return Loss(worker, status, silent, failure[0], diagnostics=failure[1])

    def _end(self, worker: int) -> None:
        """Kill a worker if it still runs, and release its process object and its connection."""
        self._unwatch(worker)
        process, connection = self._processes.pop(worker), self._connections.pop(worker)
        connection.close()
        kill_worker(process)
        process.join(_TO_END_S)
        with contextlib.suppress(ValueError):
            process.close()


def split_evenly(count: int, workers: int) -> Iterator[slice]:
    """Divide ``count`` environments among workers: yield the slice of indices of each worker, in order.

    The lengths of the slices differ by at most one.
    """
    for worker in range(workers):
        yield slice(worker * count // workers, (worker + 1) * count // workers)
