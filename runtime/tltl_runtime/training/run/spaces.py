"""Check the observation and action spaces of a training's environment, before anything starts."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from tltl_runtime.game.registry import game_of
from tltl_runtime.policies.spaces.layouts import SpaceLayouts, space_layouts
from tltl_runtime.spec.wrapper import TltlEnv
from tltl_runtime.training.files.run_file import TrainingRun
from tltl_runtime.training.files.settings import read_settings
from tltlc.api import Diagnostic, TltlError, record


@record
class TrainingSpaces:
    """What a training must know about its environment before it begins.

    ``layouts`` say how observations and actions become arrays; None if the network uses them
    without conversion. ``searches`` says whether the training searches for demonstrations. This
    needs two things: the settings ask for it, and the environment's info says in ``cell`` where the
    player is.
    """

    layouts: SpaceLayouts | None
    searches: bool


def training_spaces(run: TrainingRun) -> TrainingSpaces:
    """Make an environment of the training, examine its spaces and its info, and close it.

    Raises:
        TltlError: TLT0844, policies do not support its spaces; TLT0862, the settings ask for a
            search, but the info does not say where the player is; the errors of ``make_env``.
    """
    env = env_function(run)()
    try:
        layouts = space_layouts(env.observation_space, env.action_space, run.sensors)
        _, info = env.reset(seed=run.seed)
    finally:
        env.close()
    has_cells = "cell" in info
    if not has_cells and run.settings.searches and run.settings.exploration.ways != read_settings().exploration.ways:
        title = f"`exploration.ways` asks for a search, but `{run.level}` does not say in which cell the player is"
        help_ = "leave the setting out: the training then begins each episode at the start"
        raise TltlError([Diagnostic("TLT0862", title, help=help_)])
    return TrainingSpaces(layouts, run.settings.searches and has_cells)


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
