"""The game's levels as vector environments, and what ``gymnasium.make_vec`` makes of their ids."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

from tltl_runtime.stealth.env import make_env
from tltl_runtime.stealth.levels.file import load_level
from tltl_runtime.stealth.senses.sensors import SensorChoice
from tltl_runtime.task import load_task
from tltl_runtime.vector.env import WorkerVectorEnv
from tltlc.automaton.fspa import Fspa
from tltlc.monitor import RewardOptions


def make_vec(
    level: str,
    variant: str = "v0",
    num_envs: int = 1,
    workers: int | None = None,
    *,
    spec: str | Path | Fspa | None = None,
    sensors: SensorChoice | None = None,
    reward: RewardOptions | None = None,
    render_mode: str | None = None,
    **options: Any,
) -> WorkerVectorEnv:
    """``num_envs`` of what :func:`~tltl_runtime.stealth.env.make_env` makes, in ``workers`` processes.

    ``options`` and errors are those of :class:`~tltl_runtime.vector.WorkerVectorEnv` and of ``make_env``.
    """
    # Compiled once, and not by each worker for each of its environments.
    fspa = spec if isinstance(spec, Fspa) else load_task(load_level(level, variant).spec if spec is None else spec).fspa
    make = partial(make_env, level, variant, fspa, sensors=sensors, reward=reward, render_mode=render_mode)
    return WorkerVectorEnv([make] * num_envs, workers, names=[f"{level} {variant}"] * num_envs, **options)


def navigation(**options: Any) -> WorkerVectorEnv:
    """``tltl/Navigation-v0``."""
    return make_vec("navigation", **options)


def cover_and_hide(**options: Any) -> WorkerVectorEnv:
    """``tltl/CoverAndHide-v0``."""
    return make_vec("cover_and_hide", **options)


def branching(**options: Any) -> WorkerVectorEnv:
    """``tltl/Branching-v0``."""
    return make_vec("branching", **options)
