"""When a training searches for demonstrations: before it begins, and at a standstill."""

from __future__ import annotations

from collections.abc import Callable

from tltl_runtime.training.exploration.reverse_curriculum import ReverseCurriculum
from tltl_runtime.training.exploration.search import PolicyFunction, SearchProgress, TrajectorySearch
from tltl_runtime.training.files.checkpoint import Checkpoint
from tltl_runtime.training.files.run_file import TrainingRun
from tltl_runtime.training.ppo.distributed import ProcessGroup
from tltl_runtime.training.ppo.environment import TrainingEnv
from tltl_runtime.training.ppo.random_streams import Purpose, stream
from tltl_runtime.vector import WorkerVectorEnv
from tltlc.api import Diagnostic

SearchCallback = Callable[[SearchProgress], None]
"""A function that is called from time to time with the progress of a search."""


def search_before_training(
    run: TrainingRun,
    group: ProcessGroup,
    env: WorkerVectorEnv,
    curriculum: ReverseCurriculum,
    checkpoint: Checkpoint | None,
    on_search: SearchCallback,
    policy: PolicyFunction | None,
    faults: list[Diagnostic],
) -> SearchProgress | None:
    """Search for demonstrations before the training, and add them to ``curriculum``.

    ``env`` has the environments of this process. ``policy``, if there is one, plays their first
    episodes. What happens to games that are lost is added to ``faults``. Return the progress of the
    search, or None if no search is needed. With a ``checkpoint``, a search is needed only if the
    earlier search was interrupted, for example by the limit of minutes, before it found a
    demonstration, and if time is left now.
    """
    iteration, seconds = 0, 0.0
    if checkpoint:
        before, iteration, seconds = checkpoint.searched, checkpoint.iteration, checkpoint.seconds
        if before is None or before.complete or before.lengths or run.settings.stop.is_out_of_time(seconds):
            return None
    seed = stream(run, group, Purpose.SEARCH, iteration)
    search = TrajectorySearch(env, run.settings.exploration, seed, policy=policy, faults=faults)
    return _run_search(run, search, curriculum, seconds, on_search)


def search_after_standstill(
    run: TrainingRun, group: ProcessGroup, env: TrainingEnv, state: Checkpoint, on_search: SearchCallback
) -> SearchProgress | None:
    """Search for demonstrations from the agent's failed episodes, and add them to the curriculum.

    ``state`` is the state of the training. All environments begin new episodes after the search.
    Return the progress of the search. If no failed episodes are known, do nothing and return None.
    """
    if env.curriculum is None or not env.curriculum.failures:
        return None
    seed = stream(run, group, Purpose.SEARCH, state.iteration)
    search = TrajectorySearch(env.env, run.settings.exploration, seed, env.curriculum.failures, faults=env.faults)
    progress = _run_search(run, search, env.curriculum, state.seconds, on_search)
    env.restart_episodes()
    return progress


def _run_search(
    run: TrainingRun,
    search: TrajectorySearch,
    curriculum: ReverseCurriculum,
    seconds_before: float,
    on_search: SearchCallback,
) -> SearchProgress:
    """Run a search, add its demonstrations to the curriculum, and return its progress.

    The search ends early at the training's limit of minutes. ``seconds_before`` is the time that
    the training has taken before the search.
    """
    for progress in search.run():
        on_search(progress)
        if run.settings.stop.is_out_of_time(seconds_before + progress.seconds):
            break
    for demonstration in search.demonstrations:
        curriculum.add(demonstration)
    return progress
