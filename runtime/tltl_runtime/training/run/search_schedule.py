"""When a training searches for demonstrations: before it begins, and at a standstill."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from tltl_runtime.training.exploration.action_encoding import ActionEncoding
from tltl_runtime.training.exploration.memory_cells import MemoryCells
from tltl_runtime.training.exploration.reverse_curriculum import ReverseCurriculum
from tltl_runtime.training.exploration.search import FoundWays, PolicyFunction, SearchProgress, TrajectorySearch
from tltl_runtime.training.files.checkpoint import Checkpoint
from tltl_runtime.training.files.found_ways import WaysFile
from tltl_runtime.training.files.run_file import TrainingRun
from tltl_runtime.training.ppo.distributed import ProcessGroup
from tltl_runtime.training.ppo.environment import TrainingEnv
from tltl_runtime.training.ppo.random_streams import Purpose, stream
from tltl_runtime.training.run.training_clock import TrainingClock
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
    clock: TrainingClock,
) -> SearchProgress | None:
    """Search for demonstrations before the training, and add them to ``curriculum``.

    ``env`` has the environments of this process. ``policy``, if there is one, plays their first
    episodes. What happens to games that are lost is added to ``faults``. Return the progress of the
    search, or None if no search is needed. With a ``checkpoint``, a search is needed only if the
    earlier search was interrupted, for example by the limit of minutes, before it found a
    demonstration, and if time is left now. If an earlier search was stopped, the search goes on with
    the demonstrations that the earlier one stored.
    """
    iteration = 0
    if checkpoint:
        before, iteration = checkpoint.searched, checkpoint.iteration
        if before is None or before.complete or before.lengths or run.settings.stop.is_out_of_time(clock.seconds):
            return None
    file = _ways_file(run, group, checkpoint)
    options = _search_options(run, group, env, file, iteration, clock)
    search = TrajectorySearch(env, run.settings.exploration, policy=policy, faults=faults, **options)
    return _run_search(run, search, curriculum, clock, on_search, file)


def search_after_standstill(
    run: TrainingRun,
    group: ProcessGroup,
    env: TrainingEnv,
    state: Checkpoint,
    on_search: SearchCallback,
    clock: TrainingClock,
) -> SearchProgress | None:
    """Search for demonstrations from the agent's failed episodes, and add them to the curriculum.

    ``state`` is the state of the training. All environments begin new episodes after the search.
    Return the progress of the search. If no failed episodes are known, do nothing and return None.
    If an earlier search of this standstill was stopped, the search goes on with the demonstrations
    that the earlier one stored.
    """
    if env.curriculum is None or not env.curriculum.failures:
        return None
    file = _ways_file(run, group, state)
    options = _search_options(run, group, env.env, file, state.iteration, clock)
    failures = env.curriculum.failures
    search = TrajectorySearch(env.env, run.settings.exploration, failures=failures, faults=env.faults, **options)
    progress = _run_search(run, search, env.curriculum, clock, on_search, file)
    env.restart_episodes()
    return progress


def _search_options(
    run: TrainingRun, group: ProcessGroup, env: WorkerVectorEnv, file: WaysFile, iteration: int, clock: TrainingClock
) -> dict[str, Any]:
    """Return the options ``seed``, ``earlier``, ``distances`` and ``memory`` of a search after an iteration.

    If ``file`` has ways of an earlier search that was stopped, the time of that search is added to ``clock``.
    """
    earlier = file.read(ActionEncoding(env.single_action_space))
    clock.add(earlier.progress.seconds if earlier else 0.0)
    seed = stream(run, group, Purpose.SEARCH, iteration, len(earlier.demonstrations) if earlier else 0)
    distances = [state.distance for state in run.fspa.states]
    return {"seed": seed, "earlier": earlier, "distances": distances, "memory": MemoryCells(run.fspa)}


def _ways_file(run: TrainingRun, group: ProcessGroup, state: Checkpoint | None) -> WaysFile:
    """Return the file for the demonstrations of the next search of this process, which begins in ``state``."""
    return WaysFile(run, group.rank, state.searched.steps if state and state.searched else 0)


def _run_search(
    run: TrainingRun,
    search: TrajectorySearch,
    curriculum: ReverseCurriculum,
    clock: TrainingClock,
    on_search: SearchCallback,
    file: WaysFile,
) -> SearchProgress:
    """Run a search, add its demonstrations to the curriculum, and return its progress.

    The search ends early at the training's limit of minutes, by ``clock``. The demonstrations found
    so far are in ``file``, so that a search that is stopped does not lose them.
    """
    stored = len(search.demonstrations)
    for progress in search.run():
        if len(search.demonstrations) > stored:
            file.write(FoundWays(progress, tuple(search.demonstrations)))
            stored = len(search.demonstrations)
        on_search(progress)
        if run.settings.stop.is_out_of_time(clock.seconds):
            break
    for demonstration in search.demonstrations:
        curriculum.add(demonstration)
    return progress
