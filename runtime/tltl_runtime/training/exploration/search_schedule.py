"""When a training searches for ways to meet the spec: before it begins, and at a standstill."""

from __future__ import annotations

from collections.abc import Callable

from tltl_runtime.training.exploration.reverse_curriculum import ReverseCurriculum
from tltl_runtime.training.exploration.search import Player, Searched, TrajectorySearch
from tltl_runtime.training.ppo.distributed import Peers
from tltl_runtime.training.ppo.environment import TrainingEnv
from tltl_runtime.training.ppo.random_streams import Purpose, stream
from tltl_runtime.training.run.checkpoint import Checkpoint
from tltl_runtime.training.run.run_file import Run
from tltl_runtime.vector import WorkerVectorEnv

Searching = Callable[[Searched], None]
"""Called from time to time with the progress of a search."""


def searched_first(
    run: Run,
    own: Peers,
    played: WorkerVectorEnv,
    restarts: ReverseCurriculum,
    checkpoint: Checkpoint | None,
    searching: Searching,
    player: Player | None,
) -> Searched | None:
    """Search for ways before the training; a ``player`` plays first.

    Returns None if the search was done before.  A search that was broken off by a limit before it
    found a way is repeated if there is time for it.
    """
    iteration, seconds = 0, 0.0
    if checkpoint:
        before, iteration, seconds = checkpoint.searched, checkpoint.iteration, checkpoint.seconds
        if before is None or before.complete or before.lengths or run.settings.stop.is_late(seconds):
            return None
    search = TrajectorySearch(
        played, run.settings.exploration, stream(run, own, Purpose.SEARCH, iteration), player=player
    )
    return _run_search(run, search, restarts, seconds, searching)


def searched_again(run: Run, own: Peers, env: TrainingEnv, state: Checkpoint, searching: Searching) -> Searched | None:
    """Search for ways from the agent's failures, in a training in this ``state``.

    All episodes begin anew after the search.  Returns None if no failures are known.
    """
    if env.restarts is None or not env.restarts.failures:
        return None
    seed = stream(run, own, Purpose.SEARCH, state.iteration)
    search = TrajectorySearch(env.env, run.settings.exploration, seed, env.restarts.failures)
    searched = _run_search(run, search, env.restarts, state.seconds, searching)
    env.begin_anew()
    return searched


def _run_search(
    run: Run, search: TrajectorySearch, restarts: ReverseCurriculum, before_s: float, searching: Searching
) -> Searched:
    """Run a search, at most to the training's limit of minutes; add its ways to the restarts."""
    for searched in search.run():
        searching(searched)
        if run.settings.stop.is_late(before_s + searched.seconds):
            break
    for way in search.ways:
        restarts.add(way)
    return searched
