"""The levels of games as vector environments."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any, Literal

import gymnasium

from tltl_runtime.game.level import default_spec
from tltl_runtime.game.level_name import Variant, parse_variant
from tltl_runtime.game.registry import game_of
from tltl_runtime.game.sensors import SensorChoice
from tltl_runtime.spec.task import read_spec
from tltl_runtime.spec.wrapper import TltlEnv
from tltl_runtime.vector.env import WorkerVectorEnv
from tltlc.api import Fspa, RewardOptions


def make_vec(
    level: str,
    variant: str | Variant = "v0",
    num_envs: int = 1,
    workers: int | Literal["ray"] | None = None,
    *,
    spec: str | Path | Fspa | None = None,
    sensors: SensorChoice | None = None,
    reward: RewardOptions | None = None,
    params: Mapping[str, float] | None = None,
    render_mode: str | None = None,
    wrapper: Callable[[Callable[[], TltlEnv]], gymnasium.Env[Any, Any]] | None = None,
    **options: Any,
) -> WorkerVectorEnv:
    """Make a vector environment of ``num_envs`` environments of a level, stepped by ``workers``.

    :meth:`~tltl_runtime.game.game.Game.make_env` makes the environments; see there for the arguments
    that are not explained here. By default, the ``spec`` is that of the level. ``wrapper`` is an
    importable function. It gets a function that makes an environment, and returns the environment to
    use. ``workers`` and ``options`` are arguments of :class:`~tltl_runtime.vector.WorkerVectorEnv`.

    Raises:
        ValueError: the render mode is ``human`` and there are several environments, each of which
            would open a window.
        TltlError, TypeError, WorkerError: the errors of ``make_env`` and of ``WorkerVectorEnv``.
    """
    if render_mode == "human" and num_envs > 1:
        raise ValueError("render_mode 'human' shows one environment: with several, use 'rgb_array' and call render()")
    game = game_of(level)
    if isinstance(variant, str):
        variant = parse_variant(variant)
    loaded_level = game.load_level(level, variant)
    chosen_spec = default_spec(loaded_level) if spec is None else spec
    # Compile once here, not in each worker for each of its environments.
    fspa, _ = read_spec(chosen_spec)
    game.check_fit(loaded_level, fspa, chosen_spec)
    make = partial(
        game.make_env, level, variant, fspa, sensors=sensors, reward=reward, params=params, render_mode=render_mode
    )
    function = make if wrapper is None else partial(wrapper, make)
    return WorkerVectorEnv([function] * num_envs, workers, names=[f"{level} {variant.text}"] * num_envs, **options)
