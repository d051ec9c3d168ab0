"""Check the observation and action spaces of a training's environment, before anything starts."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from tltl_runtime.game.registry import game_of
from tltl_runtime.policies.spaces.layouts import SpaceLayouts, space_layouts
from tltl_runtime.spec.wrapper import TltlEnv
from tltl_runtime.training.exploration.search_plan import (
    SearchObstacle,
    SearchPlan,
    first_info,
    obstacle_text,
    search_plan,
)
from tltl_runtime.training.files.checkpoint import Checkpoint
from tltl_runtime.training.files.run_file import CHECKPOINT, TrainingRun, resume_command
from tltl_runtime.training.ppo.distributed import process_group
from tltl_runtime.wire.env import WireEnv
from tltl_runtime.wire.wire_game import WireGame
from tltlc.api import Diagnostic, TltlError, record, replace


@record
class TrainingSpaces:
    """What a training must know about its environment before it begins.

    ``layouts`` say how observations and actions become arrays; None if the network uses them
    without conversion. ``searches`` says whether the training searches for demonstrations, and
    ``plan`` how, or why not. It is None if the settings ask for no search. ``wire`` has the deadlines
    of a game in another process; None for another game. Unless the game ``plays_at_once``, it plays
    for one environment at a time.
    """

    layouts: SpaceLayouts | None
    searches: bool
    plan: SearchPlan | None = None
    wire: WireGame | None = None
    plays_at_once: bool = True


def training_spaces(run: TrainingRun) -> TrainingSpaces:
    """Make an environment of the training, examine its spaces and its info, and close it.

    Raises:
        TltlError: TLT0844, policies do not support its spaces; the errors of ``make_env`` and of the game, which may
            also be lost at each reset (WireError).
    """
    game, env = game_of(run.level), env_function(run)()
    try:
        plays_at_once = game.plays_at_once(env)
        layouts = space_layouts(env.observation_space, env.action_space, run.sensors)
        info = first_info(env, run.seed)
        plan = search_plan(env, game, has_cells="cell" in info) if run.settings.searches else None
        wire = env.unwrapped.game if isinstance(env.unwrapped, WireEnv) else None
    finally:
        env.close()
    return TrainingSpaces(layouts, plan is not None and plan.obstacle is None, plan, wire, plays_at_once)


def check_one_at_a_time(run: TrainingRun) -> None:
    """Check that a game that is running already plays for one environment of one process alone.

    Raises:
        TltlError: TLT0862, the training has several environments, or torchrun has started several processes.
    """
    game, envs, processes = game_of(run.level), run.settings.rollout.envs, process_group().count
    if (envs == 1 and processes == 1) or not game.runs_already(game.load_level(run.level, run.variant)):
        return
    title, help_ = (
        f"the game of `{run.level}` plays for one environment at a time, and",
        "set `envs = 1` under `[rollout]`",
    )
    if processes > 1:
        title, help_ = (
            f"{title} torchrun has started {processes} processes, each with its own",
            "train without torchrun",
        )
    else:
        title = f"{title} the training has {envs}"
    help_ += ", or write `process` in place of `connect`: then tltlc starts the game"
    raise TltlError([Diagnostic("TLT0862", title, help=help_)])


def spaces_of(spaces: TrainingSpaces, checkpoint: Checkpoint | None) -> TrainingSpaces:
    """Return ``spaces`` for a training that resumes from a checkpoint.

    Earlier versions searched no game that does not name its cells itself; such a training goes on
    without a search.
    """
    if checkpoint is None or not spaces.searches or "way_seeds" in checkpoint.processes[0]:
        return spaces
    if spaces.plan is None or spaces.plan.cells == "own":
        return spaces
    plan = replace(spaces.plan, obstacle=SearchObstacle("earlier"))
    return replace(spaces, searches=False, plan=plan)


def check_search(run: TrainingRun, spaces: TrainingSpaces, checkpoint: Checkpoint | None) -> None:
    """Check that a training that resumes can still use the demonstrations of its checkpoint.

    Raises:
        TltlError: TLT0864, the checkpoint is of a training with a search, and the plan has an obstacle.
    """
    obstacle = spaces.plan.obstacle if spaces.plan else None
    if checkpoint is None or obstacle is None or "way_seeds" not in checkpoint.processes[0]:
        return
    reason = f"its training began with a search, and now the game cannot be searched: {obstacle_text(obstacle)}"
    help_ = (
        f"let the game play as it did when the training began, and continue with `{resume_command(run.folder)}`: the "
        "checkpoint stays as it is"
    )
    raise TltlError(
        [Diagnostic("TLT0864", f"cannot use the checkpoint `{run.folder / CHECKPOINT}`: {reason}", help=help_)]
    )


def env_function(run: TrainingRun) -> Callable[[], TltlEnv]:
    """Return a function that makes a new environment of the training."""
    return partial(
        game_of(run.level).make_env,
        run.level,
        run.variant,
        run.fspa,
        sensors=run.sensors,
        reward=run.settings.rewards,
        params=run.params,
    )
