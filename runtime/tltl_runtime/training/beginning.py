"""What a training begins with: its folder, its environments, and ways that were found by chance."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from tltl_runtime.stealth.env import make_env
from tltl_runtime.training.checkpoint import Checkpoint, read_checkpoint
from tltl_runtime.training.distributed import Peers, cores
from tltl_runtime.training.environment import TrainingEnv
from tltl_runtime.training.imitation import Lessons
from tltl_runtime.training.restarts import Restarts
from tltl_runtime.training.run import CHECKPOINT, RUN, Run, identity, read_run, write_run
from tltl_runtime.training.search import Search, Searched
from tltl_runtime.training.starts import Replayed
from tltl_runtime.training.streams import Purpose, stream
from tltl_runtime.vector import WorkerVectorEnv, make_vec
from tltl_runtime.vector.env import TLTL_INFO
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError


def begun(run: Run, resume: bool) -> Checkpoint | None:
    """The checkpoint to go on from, None where the training begins; what is trained is written into its folder.

    Raises:
        TltlError: TLT0864, the checkpoint cannot be resumed from; TLT0867, the folder holds a training and ``resume``
            is false; TLT0005, the folder cannot be written to.
    """
    if resume:
        checkpoint = read_checkpoint(run.folder / CHECKPOINT, identity(run))
        if read_run(run.folder) != run:
            # Its limits, or the place of its level's file, are others now, and hold when it is resumed the next time.
            write_run(run)
        return checkpoint
    if (run.folder / RUN).exists():
        title = f"`{run.folder}` holds a training already"
        help_ = f"go on with it by `tltlc train --resume {run.folder}`, or name another place with --out"
        raise TltlError([Diagnostic("TLT0867", title, help=help_)])
    write_run(run)
    return None


def environments(run: Run) -> WorkerVectorEnv:
    """The environments of this process."""
    settings, rollout = run.settings, run.settings.rollout
    return make_vec(
        run.level,
        run.variant,
        rollout.envs,
        "ray" if rollout.pool == "ray" else rollout.workers or cores(),
        spec=run.fspa,
        sensors=run.sensors,
        reward=settings.reward,
        params=run.params,
        wrapper=Replayed if settings.exploration.ways else None,
        info={**TLTL_INFO, "cell": np.int64},
    )


def prepared(
    run: Run,
    own: Peers,
    device: str,
    played: WorkerVectorEnv,
    checkpoint: Checkpoint | None,
    searching: Callable[[Searched], None],
) -> tuple[TrainingEnv, Searched | None]:
    """What rsl-rl trains with, at the beginning of episodes that no process played before, and what a search found.

    That is None where there was no need of one: ways are searched once, unless a limit broke the search off.
    """
    exploration, searched, restarts = run.settings.exploration, None, None
    iteration = checkpoint.iteration if checkpoint else 0
    if exploration.ways:
        generator = np.random.default_rng(stream(run, own, Purpose.STARTS, iteration))
        restarts = Restarts(exploration.parts, generator)
        if checkpoint is not None:
            # Of more processes than there were, the new ones know the ways of older ones.
            known = checkpoint.processes[own.rank % len(checkpoint.processes)]
            restarts.load({name: each.numpy() for name, each in known.items()})
        limit_s, before_s = run.settings.stop.minutes * 60, checkpoint.seconds if checkpoint else 0.0
        broken_off = checkpoint and checkpoint.searched and not checkpoint.searched.complete
        if checkpoint is None or (broken_off and not 0 < limit_s <= before_s):
            search = Search(played, exploration, stream(run, own, Purpose.SEARCH, iteration))
            for searched in search.run():
                searching(searched)
                if 0 < limit_s <= before_s + searched.seconds:
                    break
            for way in search.ways:
                restarts.add(way)
    seeds = stream(run, own, Purpose.ENVIRONMENTS, iteration).generate_state(played.num_envs) >> 1
    make = partial(
        make_env,
        run.level,
        run.variant,
        run.fspa,
        sensors=run.sensors,
        reward=run.settings.reward,
        params=run.params,
    )
    lessons = Lessons(make, restarts) if restarts and exploration.imitation else None
    return TrainingEnv(played, [int(each) for each in seeds], device, restarts, lessons), searched
