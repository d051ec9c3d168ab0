"""Workers on a Ray cluster that play the episodes of an evaluation."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import Future
from contextlib import contextmanager
from typing import Any, Final

from tltl_runtime.evaluation.player import EpisodeRequest, PolicyPlayer, Setup
from tltl_runtime.evaluation.scheduler import Result, WorkerLostError
from tltl_runtime.vector.cluster import cluster, free_cores, wait_for_actors

PATIENCE_S: Final = 120.0
"""How many seconds to wait for a free core of a busy cluster."""


@contextmanager
def ray_workers(setup: Setup, most: int, waiting: Callable[[float], None]) -> Iterator[list[RayWorker]]:
    """Start a worker on each free core of a Ray cluster, at most ``most``, for the duration of a context.

    The context manager yields the list of the workers that have started, and ends them at its exit.
    ``waiting`` is called now and then with the seconds that are left to wait for the first worker.

    Raises:
        TltlError: the errors of :func:`cluster`; TLT0852, no worker starts in time.
    """
    with cluster() as ray:
        shared = ray.put(setup)
        workers = [RayWorker(ray, shared) for _ in range(min(most, free_cores(ray)))]
        try:
            ready = wait_for_actors(ray, [worker.actor for worker in workers], PATIENCE_S, waiting)
            yield [workers[index] for index in ready]
        finally:
            for worker in workers:
                worker.close()


class RayWorker:
    """A worker that plays episodes in an actor, a process of a Ray cluster.

    ``ray`` is the module ``ray``, after it has connected to the cluster. ``setup`` is a Ray
    reference to a :class:`Setup`.
    """

    def __init__(self, ray: Any, setup: Any) -> None:
        self._ray, self._setup = ray, setup
        # No restarts: Ray would silently play the episode again that killed the actor.
        self.actor = ray.remote(num_cpus=1, max_restarts=0)(_EvaluationActor).remote()

    def play(self, request: EpisodeRequest) -> Future[Result]:
        """Start to play an episode; return a future of its result.

        The future raises the exception that the episode raised, or :class:`WorkerLostError` if the
        worker's process ends.
        """
        future: Future[Result] = Future()
        playing = self.actor.play.remote(self._setup, request).future()
        playing.add_done_callback(lambda done: self._pass_on(done, future))
        return future

    def close(self) -> None:
        """End the process of this worker."""
        self._ray.kill(self.actor)

    def _pass_on(self, done: Future[Result], future: Future[Result]) -> None:
        error = done.exception()
        if error is None:
            future.set_result(done.result())
        elif isinstance(error, self._ray.exceptions.RayTaskError):
            future.set_exception(error.cause)
        else:
            lines = str(error).splitlines() or [type(error).__name__]
            # The last line says why an actor did not start, for example a missing package.
            future.set_exception(WorkerLostError(lines[-1 if getattr(error, "actor_init_failed", False) else 0]))


class _EvaluationActor:
    """A Ray actor that plays episodes. It makes its :class:`PolicyPlayer` in the first call of ``play``.

    The constructor does not make it: if a constructor raises, Ray reports only that it failed. If a
    method raises, Ray reports the error.
    """

    def __init__(self) -> None:
        self._player: PolicyPlayer | None = None

    def play(self, setup: Setup, request: EpisodeRequest) -> Result:
        self._player = self._player or PolicyPlayer(setup)
        return self._player.play(request)
