"""What a training begins with: its folder, its environments, and what it knows of how the spec is met."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.policies.policy import NoNumbersError, Policy
from tltl_runtime.spec.wrapper import TltlEnv
from tltl_runtime.stealth.env import make_env
from tltl_runtime.training.exploration.reset_distribution import Replayed
from tltl_runtime.training.exploration.reverse_curriculum import Restarts
from tltl_runtime.training.exploration.search import Player, Searched
from tltl_runtime.training.exploration.search_schedule import Searching, searched_first
from tltl_runtime.training.exploration.self_imitation import Lessons
from tltl_runtime.training.imitation.demonstrations import Tried
from tltl_runtime.training.imitation.imitation_data import Demonstrated, read_demonstrations, record_expert
from tltl_runtime.training.ppo.distributed import Peers, cores
from tltl_runtime.training.ppo.environment import TrainingEnv
from tltl_runtime.training.ppo.penalty_weight import dearer
from tltl_runtime.training.ppo.streams import Purpose, stream
from tltl_runtime.training.run.checkpoint import Checkpoint, damaged, level_changed, read_checkpoint
from tltl_runtime.training.run.initial_policy import read_initial
from tltl_runtime.training.run.run import (
    CHECKPOINT,
    RUN,
    Run,
    demonstrations_of,
    identity,
    read_level_hash,
    read_run,
    resume_command,
    write_run,
)
from tltl_runtime.vector import WorkerVectorEnv, make_vec
from tltl_runtime.vector.env import TLTL_INFO
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError


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
        help_ = f"go on with it by `{resume_command(run.folder)}`, or name another place with --out"
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


def initial_policy(run: Run, own: Peers, checkpoint: Checkpoint | None) -> Policy | None:
    """The policy that the training begins with; None where weights are drawn, or a checkpoint has them.

    Raises:
        TltlError: TLT0940, their policy is another one now; what is wrong with its file.
    """
    if run.initial is None or checkpoint is not None:
        return None
    return own.broadcast(read_initial(run.initial, run.folder) if own.rank == 0 else None)


def prepared(
    run: Run,
    own: Peers,
    device: str,
    played: WorkerVectorEnv,
    checkpoint: Checkpoint | None,
    searching: Searching,
    to_imitate: Demonstrated | None,
    initial: Policy | None,
) -> tuple[TrainingEnv, Searched | None]:
    """What rsl-rl trains with, at the beginning of episodes that no process played before, and what a search found.

    This is None where there was no need of one: ways are searched once, unless a limit broke the search off.  The
    policy that the training begins with, ``initial``, plays first there.
    """
    searched, restarts, lessons = None, None, None
    iteration = checkpoint.iteration if checkpoint else 0
    if run.settings.searches:
        restarts = _restarts(run, own, checkpoint)
        searched = searched_first(run, own, played, restarts, checkpoint, searching, _player(run, own, initial))
        if run.settings.exploration.imitation:
            lessons = Lessons(_env_of(run), restarts)
    seeds = stream(run, own, Purpose.ENVIRONMENTS, iteration).generate_state(played.num_envs) >> 1
    first = [int(each) for each in seeds]
    return TrainingEnv(played, first, device, restarts, lessons, to_imitate, dearer(run)), searched


def _player(run: Run, own: Peers, policy: Policy | None) -> Player | None:
    """A policy that plays with sampled actions; TLT0854 where it chooses by what is no number."""
    if policy is None:
        return None
    generator = np.random.default_rng(stream(run, own, Purpose.INITIAL))

    def play(observation: Mapping[str, NDArray[Any]]) -> NDArray[np.int64]:
        try:
            return policy.choose(observation, generator)
        except NoNumbersError as error:
            title = f"the policy that the training in `{run.folder}` begins with: {error}"
            help_ = "begin with another one, or train without --from"
            raise TltlError([Diagnostic("TLT0854", title, help=help_)]) from None

    return play


def _restarts(run: Run, own: Peers, checkpoint: Checkpoint | None) -> Restarts:
    """Where the episodes of this process begin, with the ways that the checkpoint knows."""
    iteration = checkpoint.iteration if checkpoint else 0
    generator = np.random.default_rng(stream(run, own, Purpose.STARTS, iteration))
    restarts = Restarts(run.settings.exploration.parts, generator)
    if checkpoint:
        # If there are more processes than before, the new ones start with the trajectories of older ones.
        place = own.rank % len(checkpoint.processes)
        try:
            restarts.load({name: each.numpy() for name, each in checkpoint.processes[place].items()})
        except (TypeError, ValueError) as error:
            raise damaged(run.folder / CHECKPOINT, f"`processes` {place + 1}: {error}") from None
    return restarts


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
