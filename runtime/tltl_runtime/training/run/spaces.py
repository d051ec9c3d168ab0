"""The spaces of the environment of a training, which are checked before anything starts."""

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
    """What a training must know of its environment before it begins.

    ``layouts`` are those of observation and action; None if the network takes and gives their values
    as they are. ``searches`` says whether the training searches for demonstrations: its settings ask
    for that, and the environment says in the ``cell`` of its info where the player is.
    """

    layouts: SpaceLayouts | None
    searches: bool


def training_spaces(run: TrainingRun) -> TrainingSpaces:
    """Make an environment of the training, and return what it says of itself.

    Raises:
        TltlError: TLT0844, no policy can have its spaces; TLT0862, the settings ask for a search
            that is not possible there; the errors of ``make_env``.
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
    """Return a function that makes an environment of the training."""
    return partial(
        game_of(run.level).make_env,
        run.level,
        run.variant,
        run.fspa,
        sensors=run.sensors,
        reward=run.settings.rewards,
        params=run.params,
    )
