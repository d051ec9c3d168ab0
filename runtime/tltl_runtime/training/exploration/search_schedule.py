"""When a training searches ways to meet the spec: before it begins, and where it comes to a standstill."""

from __future__ import annotations

from collections.abc import Callable

from tltl_runtime.training.exploration.reverse_curriculum import Restarts
from tltl_runtime.training.exploration.search import Player, Search, Searched
from tltl_runtime.training.ppo.distributed import Peers
from tltl_runtime.training.ppo.environment import TrainingEnv
from tltl_runtime.training.ppo.streams import Purpose, stream
from tltl_runtime.training.run.checkpoint import Checkpoint
from tltl_runtime.training.run.run import Run
from tltl_runtime.vector import WorkerVectorEnv

Searching = Callable[[Searched], None]
"""What is told from time to time how far a search is."""


def searched_first(
    run: Run,
    own: Peers,
    played: WorkerVectorEnv,
    restarts: Restarts,
    checkpoint: Checkpoint | None,
    searching: Searching,
    player: Player | None,
) -> Searched | None:
    """Search ways before the training; a ``player`` plays first.

    None where that was done before, unless a limit broke it off before it found any, and now there is time for it.
    """
    iteration, seconds = 0, 0.0
    if checkpoint:
        before, iteration, seconds = checkpoint.searched, checkpoint.iteration, checkpoint.seconds
        if before is None or before.complete or before.lengths or run.settings.stop.is_late(seconds):
            return None
    search = Search(played, run.settings.exploration, stream(run, own, Purpose.SEARCH, iteration), player=player)
    return _made(run, search, restarts, seconds, searching)


def searched_again(run: Run, own: Peers, env: TrainingEnv, state: Checkpoint, searching: Searching) -> Searched | None:
    """Search ways for what the agent fails in, in a training that is in this state; its episodes begin anew.

    None where nothing is known of failures.
    """
    if env.restarts is None or not env.restarts.failures:
        return None
    seed = stream(run, own, Purpose.SEARCH, state.iteration)
    search = Search(env.env, run.settings.exploration, seed, env.restarts.failures)
    searched = _made(run, search, env.restarts, state.seconds, searching)
    env.begin_anew()
    return searched


def _made(run: Run, search: Search, restarts: Restarts, before_s: float, searching: Searching) -> Searched:
    """Make a search, until the training's limit of minutes at the latest; the restarts know its ways then."""
    for searched in search.run():
        searching(searched)
        if run.settings.stop.is_late(before_s + searched.seconds):
            break
    for way in search.ways:
        restarts.add(way)
    return searched
