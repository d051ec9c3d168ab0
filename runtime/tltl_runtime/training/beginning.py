"""What a training begins with: its folder, its environments, and ways that were found by chance."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from shlex import quote

import numpy as np
from torch import Tensor

from tltl_runtime.stealth.env import make_env
from tltl_runtime.training.checkpoint import Checkpoint, level_changed, read_checkpoint
from tltl_runtime.training.demonstrated import Demonstrated, read_demonstrations, record_expert
from tltl_runtime.training.demonstrations import Tried
from tltl_runtime.training.distributed import Peers, cores
from tltl_runtime.training.environment import TrainingEnv
from tltl_runtime.training.initial import read_initial
from tltl_runtime.training.restarts import Restarts
from tltl_runtime.training.run import (
    CHECKPOINT,
    RUN,
    Run,
    demonstrations_of,
    identity,
    read_level_hash,
    read_run,
    write_run,
)
from tltl_runtime.training.search import Search, Searched
from tltl_runtime.training.self_imitation import Lessons
from tltl_runtime.training.starts import Replayed
from tltl_runtime.training.streams import Purpose, stream
from tltl_runtime.vector import WorkerVectorEnv, make_vec
from tltl_runtime.vector.env import TLTL_INFO
from tltl_runtime.wrapper import TltlEnv
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.monitor.reward import terminal_penalty
from tltlc.record import replace


def begun(run: Run, resume: bool) -> Checkpoint | None:
    """The checkpoint to go on from, None where the training begins; what is trained is written into its folder.

    Raises:
        TltlError: TLT0864, the checkpoint cannot be resumed from; TLT0868, the level is another one now; TLT0867, the
            folder holds a training and ``resume`` is false; TLT0005, the folder cannot be written to.
    """
    if resume:
        checkpoint = read_checkpoint(run.folder / CHECKPOINT, identity(run))
        if checkpoint is None and read_level_hash(run.folder) != identity(run)["level"]:
            raise level_changed(run.folder)
        if read_run(run.folder) != run:
            # Its limits, or the place of its level's file, are others now, and hold when it is resumed the next time.
            write_run(run)
        return checkpoint
    if (run.folder / RUN).exists():
        title = f"`{run.folder}` holds a training already"
        help_ = f"go on with it by `tltlc train --resume {quote(str(run.folder))}`, or name another place with --out"
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
        reward=settings.rewards,
        params=run.params,
        wrapper=Replayed if settings.searches else None,
        info={**TLTL_INFO, "cell": np.int64},
    )


def demonstrated(run: Run, own: Peers, recording: Callable[[Tried], None]) -> Demonstrated | None:
    """What is imitated, None where nothing is; the expert's are recorded first, as far as they are not there.

    Raises:
        TltlError: TLT0920, the expert fails; TLT0921, there is nothing to imitate; what is wrong with a recording.
    """
    if not run.settings.imitates:
        return None
    found = None
    if own.rank == 0:
        folder, make = demonstrations_of(run), _env_of(run)
        if run.demonstrations is None:
            record_expert(folder, run.settings.imitation.demonstrations, make, recording)
        found = read_demonstrations(folder, make)
    return own.broadcast(found)


def initial_weights(run: Run, own: Peers, checkpoint: Checkpoint | None) -> Mapping[str, Tensor] | None:
    """The weights that the actor begins with, by name; None where they are drawn, or a checkpoint has them.

    Raises:
        TltlError: TLT0940, their policy is another one now; what is wrong with its file.
    """
    if run.initial is None or checkpoint is not None:
        return None
    return own.broadcast(read_initial(run.initial, run.folder).weights() if own.rank == 0 else None)


def prepared(
    run: Run,
    own: Peers,
    device: str,
    played: WorkerVectorEnv,
    checkpoint: Checkpoint | None,
    searching: Callable[[Searched], None],
    demonstrated: Demonstrated | None = None,
) -> tuple[TrainingEnv, Searched | None]:
    """What rsl-rl trains with, at the beginning of episodes that no process played before, and what a search found.

    This is None where there was no need of one: ways are searched once, unless a limit broke the search off.
    """
    exploration, searched, restarts, lessons = run.settings.exploration, None, None, None
    iteration = checkpoint.iteration if checkpoint else 0
    if run.settings.searches:
        restarts = _restarts(run, own, checkpoint)
        if checkpoint is None or _broken_off(run, checkpoint):
            searched = _searched(run, own, played, checkpoint, restarts, searching)
        if exploration.imitation:
            lessons = Lessons(_env_of(run), restarts)
    seeds = stream(run, own, Purpose.ENVIRONMENTS, iteration).generate_state(played.num_envs) >> 1
    first = [int(each) for each in seeds]
    return TrainingEnv(played, first, device, restarts, lessons, demonstrated, dearer(run)), searched


def dearer(run: Run) -> Callable[[int], float] | None:
    """How much more the undiscounted terminal penalty is after so many steps; None where it is not to rise to that."""
    limit, options = run.fspa.limit_steps, run.settings.reward.options
    if limit is None or run.settings.imitates or not run.settings.reward.rises:
        return None
    whole = replace(options, terminal_penalty="undiscounted")
    return lambda steps: terminal_penalty(limit, steps, whole) - terminal_penalty(limit, steps, options)


def _restarts(run: Run, own: Peers, checkpoint: Checkpoint | None) -> Restarts:
    """Where the episodes of this process begin, with the ways that the checkpoint knows."""
    iteration = checkpoint.iteration if checkpoint else 0
    generator = np.random.default_rng(stream(run, own, Purpose.STARTS, iteration))
    restarts = Restarts(run.settings.exploration.parts, generator)
    if checkpoint:
        # Of more processes than there were, the new ones know the ways of older ones.
        known = checkpoint.processes[own.rank % len(checkpoint.processes)]
        restarts.load({name: each.numpy() for name, each in known.items()})
    return restarts


def _broken_off(run: Run, checkpoint: Checkpoint) -> bool:
    """Whether a limit broke off the search before the training, and now there is time to make it anew."""
    limit_s, searched = run.settings.stop.minutes * 60, checkpoint.searched
    return searched is not None and not searched.complete and not 0 < limit_s <= checkpoint.seconds


def _searched(
    run: Run,
    own: Peers,
    played: WorkerVectorEnv,
    checkpoint: Checkpoint | None,
    restarts: Restarts,
    searching: Callable[[Searched], None],
) -> Searched | None:
    """Search ways for ``restarts``, until the training's limit of minutes at the latest."""
    iteration, before_s = (checkpoint.iteration, checkpoint.seconds) if checkpoint else (0, 0.0)
    search = Search(played, run.settings.exploration, stream(run, own, Purpose.SEARCH, iteration))
    return _made(run, search, before_s, restarts, searching)


def searched_again(
    run: Run, own: Peers, env: TrainingEnv, iteration: int, before_s: float, searching: Callable[[Searched], None]
) -> Searched | None:
    """Search ways for what the agent fails in, after an iteration and ``before_s`` seconds; its episodes begin anew.

    None where nothing is known of failures.
    """
    if env.restarts is None or not env.restarts.failures:
        return None
    seed = stream(run, own, Purpose.SEARCH, iteration)
    search = Search(env.env, run.settings.exploration, seed, env.restarts.failures)
    searched = _made(run, search, before_s, env.restarts, searching)
    env.begin_anew()
    return searched


def _made(
    run: Run, search: Search, before_s: float, restarts: Restarts, searching: Callable[[Searched], None]
) -> Searched | None:
    """Make a search, until the training's limit of minutes at the latest; the restarts know its ways then."""
    limit_s, searched = run.settings.stop.minutes * 60, None
    for searched in search.run():
        searching(searched)
        if 0 < limit_s <= before_s + searched.seconds:
            break
    for way in search.ways:
        restarts.add(way)
    return searched


def _env_of(run: Run) -> Callable[[], TltlEnv]:
    """What makes an environment of the training."""
    return partial(
        make_env,
        run.level,
        run.variant,
        run.fspa,
        sensors=run.sensors,
        reward=run.settings.rewards,
        params=run.params,
    )
