"""The workers as their owner sees them: started, asked, watched, and stopped."""

from __future__ import annotations

import contextlib
import selectors
import time
from collections.abc import Iterator, Sequence
from multiprocessing.connection import Connection
from multiprocessing.context import SpawnContext, SpawnProcess
from typing import Any, Final

from gymnasium.vector import AutoresetMode
from gymnasium.vector.utils import CloudpickleWrapper

from tltl_runtime.support.child_processes import interrupts_withheld
from tltl_runtime.vector.errors import Loss
from tltl_runtime.vector.memory import Rows
from tltl_runtime.vector.worker import CLOSE, FAILED, EnvFunction, work
from tltlc.core.record import replace

TO_START_S: Final = 120.0
"""How long a worker may take to import what it needs and to make its environments, at the least."""
_TO_END_S: Final = 5.0
"""How long a worker that is told to end, or was killed, may take."""


class Workers:
    """Processes that step environments; worker w has those of the w-th slice of ``shares``.

    A process is spawned, not forked: forking with threads of torch or OpenBLAS about would be a gamble.  What
    is asked of all is answered in order of the workers, by what each gave or by a :class:`Loss`: it ended, raised,
    or was silent for ``timeout`` seconds.  After a loss, ``start`` puts a new process in its place.
    """

    def __init__(
        self,
        context: SpawnContext,
        functions: Sequence[EnvFunction],
        shares: Sequence[slice],
        rows: Rows,
        autoreset: AutoresetMode,
        timeout: float,
    ) -> None:
        self.shares = tuple(shares)
        self._context, self._functions, self._rows = context, functions, rows
        self._autoreset, self._timeout = autoreset, timeout
        self._processes: dict[int, SpawnProcess] = {}
        self._connections: dict[int, Connection] = {}
        self._asked: set[int] = set()
        """Workers whose answers are waited for; no other is watched by the selector."""
        self._selector = selectors.DefaultSelector()

    @property
    def is_waiting(self) -> bool:
        """Whether an answer was not waited for, as after a Ctrl-C."""
        return bool(self._asked)

    def pid(self, worker: int) -> int | None:
        """The process id of a worker."""
        return self._processes[worker].pid

    def start(self, workers: Sequence[int]) -> list[Loss]:
        """Start these, wait until their environments are made, and tell which did not come so far."""
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
            with interrupts_withheld():
                process.start()
            theirs.close()
            self._processes[worker], self._connections[worker] = process, ours
            self._watch(worker)
        patience = max(self._timeout, TO_START_S)
        return [replace(answer, starting=True) for answer in self.answers(patience) if isinstance(answer, Loss)]

    def ask(self, command: str, arguments: Sequence[tuple[Any, ...]]) -> list[Any]:
        """Tell all workers to do something, each with its own arguments, and wait for the answers."""
        for worker, given in enumerate(arguments):
            self.tell(worker, command, given)
        return self.answers()

    def tell(self, worker: int, command: str, arguments: tuple[Any, ...]) -> None:
        """Tell one worker to do something; ``answers`` has its answer."""
        self._watch(worker)
        # Where the other end is gone, the answer is the loss.
        with contextlib.suppress(BrokenPipeError, ConnectionResetError):
            self._connections[worker].send((command, arguments))

    def answers(self, patience: float | None = None) -> list[Any]:
        """Wait for what was asked, for ``timeout`` or ``patience`` seconds."""
        patience = self._timeout if patience is None else patience
        deadline = time.monotonic() + patience
        found: dict[int, Any] = {}
        while self._asked:
            ready = self._ready(deadline)
            for worker in ready or tuple(self._asked):
                found[worker] = self._answer(worker) if ready else self._lost(worker, silent=patience)
        return [found[worker] for worker in sorted(found)]

    def close(self) -> None:
        """End all: those that do not in time are killed."""
        for connection in self._connections.values():
            with contextlib.suppress(OSError):
                connection.send((CLOSE, ()))
        deadline = time.monotonic() + _TO_END_S
        for worker in list(self._processes):
            self._processes[worker].join(max(0.0, deadline - time.monotonic()))
            self._end(worker)
        self._asked.clear()
        self._selector.close()

    def _watch(self, worker: int) -> None:
        """Wait for an answer of this one, or for its end."""
        self._asked.add(worker)
        for file in (self._connections[worker].fileno(), self._processes[worker].sentinel):
            self._selector.register(file, selectors.EVENT_READ, worker)

    def _unwatch(self, worker: int) -> None:
        for file in (self._connections[worker].fileno(), self._processes[worker].sentinel):
            # It is watched by one of them alone where a Ctrl-C came between the two, and by none where it is idle.
            with contextlib.suppress(KeyError):
                self._selector.unregister(file)
        self._asked.discard(worker)

    def _ready(self, deadline: float) -> set[int]:
        """Of those that were asked, who answered or ended; none once the deadline is over."""
        left = max(0.0, deadline - time.monotonic())
        return {key.data for key, _ in self._selector.select(left)}

    def _answer(self, worker: int) -> Any:
        connection = self._connections[worker]
        try:
            # Of one that ended the last words count, where there are any.
            if connection.poll():
                outcome, answer = connection.recv()
                self._unwatch(worker)
                return self._lost(worker, traceback=answer) if outcome == FAILED else answer
        except (EOFError, OSError):
            pass
        return self._lost(worker)

    def _lost(self, worker: int, *, silent: float | None = None, traceback: str = "") -> Loss:
        process = self._processes[worker]
        if silent is None:
            process.join(_TO_END_S)
        status = process.exitcode
        self._end(worker)
        return Loss(worker, status, silent, traceback)

    def _end(self, worker: int) -> None:
        """Make sure that a worker is gone, and forget it."""
        self._unwatch(worker)
        process, connection = self._processes.pop(worker), self._connections.pop(worker)
        connection.close()
        if process.is_alive():
            process.kill()
            process.join(_TO_END_S)
        with contextlib.suppress(ValueError):
            process.close()


def shared_out(count: int, workers: int) -> Iterator[slice]:
    """``count`` environments for so many workers: slices whose lengths differ by one at most."""
    for worker in range(workers):
        yield slice(worker * count // workers, (worker + 1) * count // workers)
