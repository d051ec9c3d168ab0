"""Workers of a Ray cluster."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import Future
from contextlib import contextmanager
from typing import Any

from tltl_runtime.evaluation.player import Player, Result, Setup, Task
from tltl_runtime.evaluation.spread import LostError
from tltl_runtime.vector.cluster import cluster, free_cores


@contextmanager
def ray_workers(setup: Setup, most: int) -> Iterator[list[RayWorker]]:
    """A worker on each free core of the cluster, up to ``most``; errors as of :func:`cluster`."""
    with cluster() as ray:
        shared = ray.put(setup)
        workers = [RayWorker(ray, shared) for _ in range(min(most, free_cores(ray)))]
        try:
            yield workers
        finally:
            for worker in workers:
                worker.close()


class RayWorker:
    """A player somewhere in the cluster; ``setup`` is a reference to its :class:`Setup`."""

    def __init__(self, ray: Any, setup: Any) -> None:
        self._ray = ray
        # Ray would restart an actor and play again, silently, what has killed it.
        self._actor = ray.remote(num_cpus=1, max_restarts=0)(Player).remote(setup)

    def play(self, task: Task) -> Future[Result]:
        """Begin an episode."""
        future: Future[Result] = Future()
        self._actor.play.remote(task).future().add_done_callback(lambda done: self._pass_on(done, future))
        return future

    def close(self) -> None:
        """End the actor."""
        self._ray.kill(self._actor)

    def _pass_on(self, done: Future[Result], future: Future[Result]) -> None:
        error = done.exception()
        if error is None:
            future.set_result(done.result())
        elif isinstance(error, self._ray.exceptions.RayTaskError):
            future.set_exception(error.cause)
        else:
            future.set_exception(LostError(next(iter(str(error).splitlines()), type(error).__name__)))
