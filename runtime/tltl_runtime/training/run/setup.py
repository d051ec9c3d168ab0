"""Prepare a training: its folder, environments, demonstrations, initial policy and ways."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.game.registry import registered_game
from tltl_runtime.policies.policy import NoNumbersError, Policy
from tltl_runtime.spec.wrapper import TltlEnv
from tltl_runtime.training.exploration.replayed_starts import Replayed
from tltl_runtime.training.exploration.reverse_curriculum import ReverseCurriculum
from tltl_runtime.training.exploration.search import Player, Searched
from tltl_runtime.training.exploration.search_schedule import Searching, searched_first
from tltl_runtime.training.exploration.self_imitation import SelfImitation
from tltl_runtime.training.imitation.demonstrations import Tried
from tltl_runtime.training.imitation.imitation_data import Demonstrated, read_demonstrations, record_expert
from tltl_runtime.training.ppo.distributed import Peers, cores
from tltl_runtime.training.ppo.environment import TrainingEnv
from tltl_runtime.training.ppo.penalty_weight import raised_penalty
from tltl_runtime.training.ppo.random_streams import Purpose, stream
from tltl_runtime.training.run.checkpoint import Checkpoint, damaged, level_changed, read_checkpoint
from tltl_runtime.training.run.initial_policy import read_initial
from tltl_runtime.training.run.run_file import (
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
from tltlc.api import Diagnostic, TltlError


def begun(run: Run, resume: bool) -> Checkpoint | None:
    """Write ``run.json`` if needed; return the checkpoint to resume from, None for a new training.

    Raises:
        TltlError: TLT0864, the checkpoint cannot be resumed from; TLT0868, the level has changed;
            TLT0867, the folder holds a training and ``resume`` is false; TLT0005, the folder cannot
            be written to.
    """
    if resume:
        checkpoint = read_checkpoint(run.folder / CHECKPOINT, identity(run))
        if checkpoint is None and read_level_hash(run.folder) != identity(run)["level"]:
            raise level_changed(run.folder)
        if read_run(run.folder) != run:
            # The limits or the path of the level's file have changed: keep them for the next time it is resumed.
            write_run(run)
        return checkpoint
    if (run.folder / RUN).exists():
        title = f"`{run.folder}` holds a training already"
        help_ = f"go on with it by `{resume_command(run.folder)}`, or name another place with --out"
        raise TltlError([Diagnostic("TLT0867", title, help=help_)])
    write_run(run)
    return None


def environments(run: Run) -> WorkerVectorEnv:
    """Make the environments of this process."""
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
    """Return the demonstrations to imitate, None without imitation.

    Missing demonstrations of the expert are recorded first.

    Raises:
        TltlError: TLT0920, the expert fails; TLT0921, there is nothing to imitate; TLT0005, a
            recording cannot be written.
    """
    if not run.settings.imitates:
        return None
    decisions = None
    if own.rank == 0:
        folder, make = demonstrations_of(run), _env_of(run)
        if run.demonstrations is None:
            record_expert(folder, run.settings.imitation.demonstrations, make, recording)
        decisions = read_demonstrations(folder, make)
    return own.broadcast(decisions)


def initial_policy(run: Run, own: Peers, checkpoint: Checkpoint | None) -> Policy | None:
    """Return the policy that the training begins with; None with random weights or a checkpoint.

    Raises:
        TltlError: TLT0940, the policy's file is missing or has changed; the errors of
            ``read_policy``.
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
    """Return the environment for rsl-rl, at the start of new episodes, and the result of a search.

    The seeds depend on process and iteration, so that episodes differ from those played before.
    The result is None if there is no search.  A search is not repeated, unless a limit broke it off
    before it found a way.  ``initial``, the policy that the training begins with, plays first in
    the search.
    """
    searched, restarts, lessons = None, None, None
    iteration = checkpoint.iteration if checkpoint else 0
    if run.settings.searches:
        restarts = _restarts(run, own, checkpoint)
        searched = searched_first(run, own, played, restarts, checkpoint, searching, _player(run, own, initial))
        if run.settings.exploration.imitation:
            lessons = SelfImitation(_env_of(run), restarts)
    seeds = stream(run, own, Purpose.ENVIRONMENTS, iteration).generate_state(played.num_envs) >> 1
    reset_seeds = [int(seed) for seed in seeds]
    limit_steps = run.fspa.limit_steps
    env = TrainingEnv(played, reset_seeds, device, restarts, lessons, to_imitate, raised_penalty(run), limit_steps)
    return env, searched


def _player(run: Run, own: Peers, policy: Policy | None) -> Player | None:
    """Return a player that samples the actions of a policy.

    The player raises TltlError, TLT0854, if the observation or the policy's output is not finite.
    """
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


def _restarts(run: Run, own: Peers, checkpoint: Checkpoint | None) -> ReverseCurriculum:
    """Return the restarts of this process, with the ways of the checkpoint."""
    iteration = checkpoint.iteration if checkpoint else 0
    generator = np.random.default_rng(stream(run, own, Purpose.STARTS, iteration))
    restarts = ReverseCurriculum(run.settings.exploration.parts, generator)
    if checkpoint:
        # If there are more processes than before, the new ones begin with the ways of older ones.
        rank = own.rank % len(checkpoint.processes)
        try:
            restarts.load({name: tensor.numpy() for name, tensor in checkpoint.processes[rank].items()})
        except (TypeError, ValueError) as error:
            raise damaged(run.folder / CHECKPOINT, f"`processes` {rank + 1}: {error}") from None
    return restarts


def _env_of(run: Run) -> Callable[[], TltlEnv]:
    """Return a function that makes an environment of the training."""
    return partial(
        registered_game().make_env,
        run.level,
        run.variant,
        run.fspa,
        sensors=run.sensors,
        reward=run.settings.rewards,
        params=run.params,
    )
