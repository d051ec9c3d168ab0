"""Prepare a training.

The functions make the training's folder and environments, record or read demonstrations, read the
policy to begin with, and run the first search for demonstrations.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from math import ceil
from typing import Any, Literal

import gymnasium
import numpy as np
from numpy.typing import NDArray

from tltl_runtime.evaluation.clauses import clause_judge
from tltl_runtime.game.registry import game_of
from tltl_runtime.policies.policy import NotFiniteError, Policy
from tltl_runtime.spec.wrapper import TltlEnv
from tltl_runtime.training.exploration.action_encoding import ActionEncoding
from tltl_runtime.training.exploration.replayed_starts import ReplayedStartEnv
from tltl_runtime.training.exploration.returning_env import ReturningEnv
from tltl_runtime.training.exploration.reverse_curriculum import ReverseCurriculum
from tltl_runtime.training.exploration.search import PolicyFunction, SearchProgress
from tltl_runtime.training.exploration.self_imitation import SelfImitation
from tltl_runtime.training.files.checkpoint import Checkpoint, checkpoint_error, level_changed_error, read_checkpoint
from tltl_runtime.training.files.metrics import METRICS
from tltl_runtime.training.files.run_file import (
    CHECKPOINT,
    RUN,
    TrainingRun,
    demonstrations_of,
    identity,
    read_level_hash,
    read_run,
    resume_command,
    write_run,
)
from tltl_runtime.training.imitation.demonstrations import Attempt
from tltl_runtime.training.imitation.imitation_data import ImitationData, read_demonstrations, record_expert
from tltl_runtime.training.ppo.distributed import ProcessGroup, cores
from tltl_runtime.training.ppo.environment import TrainingEnv
from tltl_runtime.training.ppo.random_streams import Purpose, stream
from tltl_runtime.training.ppo.scheduled_weights import penalty_rise
from tltl_runtime.training.run.initial_policy import read_initial_policy
from tltl_runtime.training.run.search_schedule import SearchCallback, search_before_training
from tltl_runtime.training.run.spaces import TrainingSpaces, env_function
from tltl_runtime.training.run.training_clock import TrainingClock
from tltl_runtime.vector import WorkerVectorEnv, make_vec
from tltl_runtime.vector.env import TIMEOUT_S, TLTL_INFO
from tltl_runtime.wire.lost_episodes import MOST_IN_A_ROW
from tltl_runtime.wire.surviving_env import surviving
from tltl_runtime.wire.wire_game import WireGame
from tltlc.api import Diagnostic, TltlError


def start_or_resume(run: TrainingRun, resume: bool) -> Checkpoint | None:
    """Write ``run.json`` if needed; return the checkpoint to resume from.

    Return None if the training starts from its beginning: ``resume`` is false, or there is no
    checkpoint yet.

    Raises:
        TltlError: TLT0864, the checkpoint cannot be resumed from; TLT0868, the level has changed;
            TLT0922, the demonstrations have changed; TLT0867, the folder holds a training and
            ``resume`` is false; TLT0005, the folder cannot be written to; the errors of
            ``read_run``.
    """
    if resume:
        checkpoint = read_checkpoint(run.folder / CHECKPOINT, identity(run))
        if checkpoint is None and read_level_hash(run.folder) != identity(run)["level"]:
            raise level_changed_error(run.folder)
        if read_run(run.folder) != run:
            # The limits or the path of the level's file have changed: store them, for the next time the training is
            # resumed.
            write_run(run)
        return checkpoint
    check_is_new(run)
    write_run(run)
    return None


def check_is_new(run: TrainingRun) -> None:
    """Raise TltlError, TLT0867, if the folder of a new training holds a training already."""
    if (run.folder / RUN).exists():
        title = f"`{run.folder}` already contains a training"
        help_ = f"continue it with `{resume_command(run.folder)}`, or name another folder with --out"
        if not (run.folder / CHECKPOINT).exists() and not (run.folder / METRICS).exists():
            title += ", which was interrupted before it learned anything"
            help_ = (
                f"start this training again with `{resume_command(run.folder)}`; for another one, remove the folder, "
                "or name another folder with --out"
            )
        raise TltlError([Diagnostic("TLT0867", title, help=help_)])


def make_environments(
    run: TrainingRun, spaces: TrainingSpaces, on_made: Callable[[int], None] | None = None
) -> WorkerVectorEnv:
    """Make the vector environment in which this process trains, and searches if ``spaces.searches``.

    ``on_made`` is called from time to time with the number of environments that are made.
    """
    settings, rollout = run.settings, run.settings.rollout
    workers: int | Literal["ray"] = "ray" if rollout.pool == "ray" else rollout.workers or cores()
    # Nobody knows yet how many cores of a cluster are free: a single worker may step all environments.
    share = rollout.envs if workers == "ray" else ceil(rollout.envs / min(workers, rollout.envs))
    options: dict[str, Any] = {"on_made": on_made}
    if spaces.wire:
        options["timeout"] = TIMEOUT_S + share * _command_s(run, spaces, spaces.wire)
    return make_vec(
        run.level,
        run.variant,
        rollout.envs,
        workers,
        spec=run.fspa,
        sensors=run.sensors,
        reward=settings.rewards,
        params=run.params,
        wrapper=_wrapper(run, spaces) if spaces.searches else surviving,
        info={**TLTL_INFO, "cell": np.int64} if spaces.searches else TLTL_INFO,
        **options,
    )


def _command_s(run: TrainingRun, spaces: TrainingSpaces, wire: WireGame) -> float:
    """Return how long an environment of a game in another process may take for a command, in seconds.

    The command may be a step that ends an episode. To begin the next one, the game may have to be
    started several times. A search then replays an episode, which is at most as long as the limit of
    the spec.
    """
    replayed = (run.fspa.limit_steps or 0) if spaces.searches else 0
    return (MOST_IN_A_ROW + 1) * (wire.start_s + wire.step_s) + (1 + replayed) * wire.step_s


def _wrapper(run: TrainingRun, spaces: TrainingSpaces) -> Callable[[Callable[[], TltlEnv]], gymnasium.Env[Any, Any]]:
    """Return the class of the environments of a search.

    Those of games without own cells need a grid. Those of games in other processes must go on if a game is lost.
    """
    plan = spaces.plan
    if plan is None or (plan.grid is None and spaces.wire is None):
        return ReplayedStartEnv
    return partial(_returning, game=game_of(run.level), grid=plan.grid, snapshots=plan.snapshots)


def _returning(make: Callable[[], TltlEnv], **options: Any) -> gymnasium.Env[Any, Any]:
    return surviving(lambda: ReturningEnv(make, **options))


def load_imitation_data(
    run: TrainingRun, group: ProcessGroup, spaces: TrainingSpaces, on_attempt: Callable[[Attempt], None]
) -> ImitationData | None:
    """Return the demonstrations to imitate; None if the agent does not learn from demonstrations.

    If the run names no folder of demonstrations, the first process records demonstrations of the
    expert first. ``on_attempt`` is called with each attempt.

    Raises:
        TltlError: TLT0920, the expert fails; TLT0921, there is nothing to imitate; TLT0005, a
            recording cannot be written.
    """
    if not run.settings.imitates:
        return None
    imitation_data = None
    if group.rank == 0:
        folder, make = demonstrations_of(run), env_function(run)
        if run.demonstrations is None:
            record_expert(folder, run.settings.imitation.demonstrations, make, on_attempt)
        imitation_data = read_demonstrations(folder, make, spaces.layouts)
    return group.broadcast(imitation_data)


def initial_policy(run: TrainingRun, group: ProcessGroup, checkpoint: Checkpoint | None) -> Policy | None:
    """Return the policy that the training begins with.

    Return None if the training begins with random weights or continues from a checkpoint.

    Raises:
        TltlError: TLT0940, the policy's file is missing or has changed; the errors of
            ``read_policy``.
    """
    if run.initial is None or checkpoint is not None:
        return None
    return group.broadcast(read_initial_policy(run.initial, run.folder) if group.rank == 0 else None)


def prepare_environment(
    run: TrainingRun,
    group: ProcessGroup,
    device: str,
    spaces: TrainingSpaces,
    vector_env: WorkerVectorEnv,
    checkpoint: Checkpoint | None,
    on_search: SearchCallback,
    imitation_data: ImitationData | None,
    initial: Policy | None,
    clock: TrainingClock,
) -> tuple[TrainingEnv, SearchProgress | None]:
    """Search for demonstrations if needed; return the environment for rsl-rl and the search's progress.

    The progress is None if there was no search. A resumed training searches again only if its
    search was interrupted before it found a demonstration. ``initial``, the policy that the
    training begins with, plays the first episodes of the search. ``on_search`` is called with the
    progress from time to time. The search ends early at the limit of minutes, by ``clock``.

    All environments have begun new episodes. Their seeds depend on the process and the iteration,
    so that resuming does not repeat episodes.
    """
    progress, curriculum, self_imitation = None, None, None
    faults: list[Diagnostic] = []
    iteration = checkpoint.iteration if checkpoint else 0
    if spaces.searches:
        encoding = ActionEncoding(vector_env.single_action_space)
        curriculum = _curriculum(run, group, checkpoint, encoding)
        progress = search_before_training(
            run,
            group,
            vector_env,
            curriculum,
            checkpoint,
            on_search,
            _policy_function(run, group, initial),
            faults,
            clock,
        )
        if run.settings.exploration.imitation:
            self_imitation = SelfImitation(env_function(run), curriculum, spaces.layouts)
    seeds = stream(run, group, Purpose.ENVIRONMENTS, iteration).generate_state(vector_env.num_envs) >> 1
    reset_seeds = [int(seed) for seed in seeds]
    limit_steps = run.fspa.limit_steps
    env = TrainingEnv(
        vector_env,
        reset_seeds,
        device,
        curriculum,
        self_imitation,
        imitation_data,
        penalty_rise(run),
        limit_steps,
        spaces.layouts,
        faults,
        clause_judge(run.fspa, run.params, _spec_source(run)),
    )
    return env, progress


def _spec_source(run: TrainingRun) -> str | None:
    """Return where the source text of the spec may be: the spec that the level is made for; None without one."""
    spec = game_of(run.level).load_level(run.level, run.variant).spec
    return spec.text if spec else None


def _policy_function(run: TrainingRun, group: ProcessGroup, policy: Policy | None) -> PolicyFunction | None:
    """Return a function that samples an action of ``policy`` for an observation; None without a policy.

    The function raises TltlError, TLT0854, if the observation or the policy's output is not finite.
    """
    if policy is None:
        return None
    generator = np.random.default_rng(stream(run, group, Purpose.INITIAL))

    def play(observation: Any) -> NDArray[Any]:
        try:
            return policy.choose_row(observation, generator)
        except NotFiniteError as error:
            title = f"the policy that the training in `{run.folder}` begins with: {error}"
            help_ = "begin with another policy, or train without --from"
            raise TltlError([Diagnostic("TLT0854", title, help=help_)]) from None

    return play


def _curriculum(
    run: TrainingRun, group: ProcessGroup, checkpoint: Checkpoint | None, encoding: ActionEncoding
) -> ReverseCurriculum:
    """Return the curriculum of this process; if there is a checkpoint, restore its state.

    Raises TltlError, TLT0864, if this state is invalid.
    """
    iteration = checkpoint.iteration if checkpoint else 0
    generator = np.random.default_rng(stream(run, group, Purpose.STARTS, iteration))
    curriculum = ReverseCurriculum(run.settings.exploration.parts, generator, encoding)
    if checkpoint:
        # If there are more processes than before, the new ones begin with the state of older ones.
        rank = group.rank % len(checkpoint.processes)
        try:
            curriculum.load({name: tensor.numpy() for name, tensor in checkpoint.processes[rank].items()})
        except (TypeError, ValueError) as error:
            raise checkpoint_error(run.folder / CHECKPOINT, f"`processes` {rank + 1}: {error}") from None
    return curriculum
