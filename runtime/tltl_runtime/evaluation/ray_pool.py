"""Workers of a Ray cluster."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import Future
from contextlib import contextmanager
from typing import Any, Final

from tltl_runtime.evaluation.player import Player, Result, Setup, Task
from tltl_runtime.evaluation.spread import LostError
from tltl_runtime.vector.cluster import cluster, free_cores, there

PATIENCE_S: Final = 120.0
"""How long a cluster whose cores are busy may take to give one, in seconds."""


@contextmanager
def ray_workers(setup: Setup, most: int, waiting: Callable[[float], None]) -> Iterator[list[RayWorker]]:
    """A worker on each free core of the cluster, up to ``most``.

    ``waiting`` is told now and then for how many more seconds the first of them is waited for.

    Raises:
        TltlError: as :func:`cluster`; TLT0852, too, where no worker starts in time.
    """
    with cluster() as ray:
        shared = ray.put(setup)
        workers = [RayWorker(ray, shared) for _ in range(min(most, free_cores(ray)))]
        try:
            came = there(ray, [worker.actor for worker in workers], PATIENCE_S, waiting)
            yield [workers[place] for place in came]
        finally:
            for worker in workers:
                worker.close()


class RayWorker:
    """A player somewhere in the cluster; ``setup`` is a reference to its :class:`Setup`."""

    def __init__(self, ray: Any, setup: Any) -> None:
        self._ray, self._setup = ray, setup
        # Ray would restart an actor and play again, silently, what has killed it.
        self.actor = ray.remote(num_cpus=1, max_restarts=0)(_Actor).remote()

    def play(self, task: Task) -> Future[Result]:
        """Begin an episode."""
        future: Future[Result] = Future()
        playing = self.actor.play.remote(self._setup, task).future()
        playing.add_done_callback(lambda done: self._pass_on(done, future))
        return future

    def close(self) -> None:
        """End the actor."""
        self._ray.kill(self.actor)

    def _pass_on(self, done: Future[Result], future: Future[Result]) -> None:
        error = done.exception()
        if error is None:
            future.set_result(done.result())
        elif isinstance(error, self._ray.exceptions.RayTaskError):
            future.set_exception(error.cause)
        else:
            lines = str(error).splitlines() or [type(error).__name__]
            # What kept an actor from beginning, such as a package that is missing there, comes last.
            future.set_exception(LostError(lines[-1 if getattr(error, "actor_init_failed", False) else 0]))


class _Actor:
    """A player of whose beginning it is known what went wrong: of an actor's own Ray tells but that it failed."""

    def __init__(self) -> None:
        self._player: Player | None = None

    def play(self, setup: Setup, task: Task) -> Result:
        self._player = self._player or Player(setup)
        return self._player.play(task)
