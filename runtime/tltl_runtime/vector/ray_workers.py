"""Workers on a Ray cluster that step environments, with the same methods as local worker processes."""

from __future__ import annotations

import multiprocessing
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from typing import Any

from gymnasium.vector import AutoresetMode
from numpy.typing import DTypeLike, NDArray

from tltl_runtime.vector.cluster import cluster, free_cores, wait_for_actors
from tltl_runtime.vector.errors import Loss
from tltl_runtime.vector.shared_memory import Rows
from tltl_runtime.vector.worker import EnvFunction, Share
from tltl_runtime.vector.workers import TO_START_S, split_evenly
from tltlc.api import TltlError, replace


class RayWorkers:
    """Actors that step environments, one on each free core of a Ray cluster.

    ``shares`` has a slice for each actor: the indices of the environments that it steps. The actors
    do not share memory with this process. So actions are sent with each command, and the rows that
    come back (the observation and results of each environment) are copied to ``rows``. In all other
    respects, the actors are like the processes of :class:`~tltl_runtime.vector.workers.Workers`.
    ``info`` has the types of the info columns of ``rows``, by name.

    Raises:
        TltlError: TLT0730, Ray is not installed; TLT0852, there is no cluster, or no worker starts.
    """

    def __init__(
        self,
        functions: Sequence[EnvFunction],
        rows: Rows,
        info: Mapping[str, DTypeLike],
        autoreset: AutoresetMode,
        timeout: float,
    ) -> None:
        self._functions, self._rows, self._info = functions, rows, info
        self._autoreset, self._timeout = autoreset, timeout
        self._actors: dict[int, Any] = {}
        self._pending: dict[Any, int] = {}
        """The worker of each reference to a pending answer."""
        self._stack = ExitStack()
        self._ray = self._stack.enter_context(cluster())
        try:
            self._idle = self._start_actors(min(free_cores(self._ray), len(functions)))
            """Actors that have a core and no environments yet."""
        except BaseException:
            self._stack.close()
            raise
        self.shares = tuple(split_evenly(len(functions), len(self._idle)))

    @property
    def is_waiting(self) -> bool:
        """Whether an answer is pending, for example after a Ctrl-C during a command."""
        return bool(self._pending)

    def pid(self, worker: int) -> int | None:
        """Return None: an actor's process may be on another machine."""
        return None

    def start(self, workers: Sequence[int], on_made: Callable[[int], None] | None = None) -> list[Loss]:
        """Start the workers with these indices, and wait until they have made their environments.

        ``on_made`` is not called, because a cluster does not share memory with this process.
        Return a :class:`Loss` for each worker that was lost while it started.

        Raises:
            TltlError: TLT0852, a new actor does not start in time.
        """
        for worker in workers:
            actor = self._actors[worker] = self._idle.pop() if self._idle else self._start_actors(1)[0]
            share = self.shares[worker]
            arguments = (len(self._functions), dict(self._rows.spaces), dict(self._info), self._autoreset)
            self._pending[actor.begin.remote(list(self._functions[share]), share, *arguments)] = worker
        answers = self.answers(max(self._timeout, TO_START_S))
        return [replace(answer, starting=True) for answer in answers if isinstance(answer, Loss)]

    def ask(self, command: str, arguments: Sequence[tuple[Any, ...]]) -> list[Any]:
        """Send a command to all workers, each with its own arguments; return their answers in order.

        The answer of a lost worker is a :class:`Loss`.
        """
        for worker, worker_arguments in enumerate(arguments):
            self.send(worker, command, worker_arguments)
        return self.answers()

    def send(self, worker: int, command: str, arguments: tuple[Any, ...]) -> None:
        """Send a command to one worker; :meth:`answers` returns its answer."""
        actions = self._rows.table["action"][self.shares[worker]]
        self._pending[self._actors[worker].do.remote(command, arguments, actions)] = worker

    def answers(self, patience: float | None = None) -> list[Any]:
        """Wait for the pending answers, and return them in the order of the workers.

        A worker that does not answer within ``patience`` seconds, by default ``timeout``, is killed.
        The answer of a lost worker is a :class:`Loss`.
        """
        patience = self._timeout if patience is None else patience
        deadline = time.monotonic() + patience
        answers: dict[int, Any] = {}
        while self._pending:
            left = max(0.0, deadline - time.monotonic())
            ready, late = self._ray.wait(list(self._pending), timeout=left)
            for reference in ready:
                worker = self._pending.pop(reference)
                answers[worker] = self._answer(worker, reference)
            if not ready:
                for reference in late:
                    worker = self._pending.pop(reference)
                    self._ray.kill(self._actors.pop(worker))
                    answers[worker] = Loss(worker, silent=patience)
        return [answers[worker] for worker in sorted(answers)]

    def close(self) -> None:
        """End all workers."""
        for actor in (*self._actors.values(), *self._idle):
            self._ray.kill(actor)
        self._actors.clear()
        self._pending.clear()
        self._stack.close()

    def _start_actors(self, most: int) -> list[Any]:
        """Start ``most`` actors; return the actors that get a core in time, and end the others.

        Raises:
            TltlError: TLT0852, no actor starts in time.
        """
        # No restarts: Ray would continue silently with a new actor, and with its environments back at their beginning.
        actors = [self._ray.remote(num_cpus=1, max_restarts=0)(_EnvironmentActor).remote() for _ in range(most)]
        started: list[Any] = []
        try:
            started = [actors[index] for index in wait_for_actors(self._ray, actors, max(self._timeout, TO_START_S))]
        finally:
            for actor in actors:
                if actor not in started:
                    self._ray.kill(actor)
        return started

    def _answer(self, worker: int, reference: Any) -> Any:
        try:
            answer, table = self._ray.get(reference)
        except self._ray.exceptions.RayError as error:
            self._ray.kill(self._actors.pop(worker))
            cause = getattr(error, "cause", None)
            diagnostics = cause.diagnostics if isinstance(cause, TltlError) else ()
            return Loss(worker, traceback=str(error), diagnostics=diagnostics)
        if table is not None:
            self._rows.table[self.shares[worker]] = table
        return answer


class _EnvironmentActor:
    """An actor that steps a share of the environments, on any machine of the cluster."""

    def begin(
        self,
        functions: Sequence[EnvFunction],
        share: slice,
        count: int,
        spaces: Mapping[str, Any],
        info: Mapping[str, DTypeLike],
        autoreset: AutoresetMode,
    ) -> tuple[None, None]:
        """Make the environments of this actor, one with each of ``functions``.

        They use the rows ``share`` of a table with ``count`` rows. Return (None, None), which has the
        form of the results of :meth:`do`: no answer, and no rows.
        """
        context = multiprocessing.get_context("spawn")
        rows = Rows(context, count, spaces["observation_space"], spaces["action_space"], info)
        self._table = rows.table[share]
        self._share = Share(functions, rows, share.start, autoreset)
        return None, None

    def do(self, command: str, arguments: tuple[Any, ...], actions: NDArray[Any]) -> tuple[Any, NDArray[Any]]:
        """Store ``actions`` in the rows, and carry out a command with ``arguments``.

        ``command`` is the name of a method of :class:`Share`. Return its result, and the rows of this
        actor's environments after the command.
        """
        self._table["action"] = actions
        return getattr(self._share, command)(*arguments), self._table
