"""Play a scene with random actions, and compare two plays."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from copy import deepcopy
from typing import Any, Final

from tltl_runtime.gymnasium_games.scene_env import SceneEnv
from tltl_runtime.support.same_values import copied, is_same, other_name
from tltlc.api import record

STEPS: Final = 200
"""The steps of a play."""

SEED: Final = 1


@record
class PlayedMoment:
    """What a game shows after a reset or a step.

    ``step`` counts the steps of the play, from 1; it is 0 after the first reset, and a later reset has
    the number of the step before. ``sample`` has the values of the signals. ``ended`` says whether the
    episode ends here.
    """

    step: int
    observation: Any
    sample: Mapping[str, Any]
    ended: bool


@record
class ScenePlay:
    """A play: its moments, including those after resets, and how many seconds it took."""

    moments: tuple[PlayedMoment, ...]
    seconds: float


@record
class PlayDifference:
    """The first difference between two plays: the signal ``name`` after ``step``, and its value in each play.

    ``name`` is empty if an episode ends here in one play only. Then the values say whether it ends.
    """

    step: int
    name: str
    first: Any
    second: Any


def drawn_actions(env: SceneEnv, count: int = STEPS, seed: int = SEED) -> list[Any]:
    """Return random actions of the environment's action space; the same seed gives the same actions."""
    space = deepcopy(env.action_space)
    space.seed(seed)
    return [space.sample() for _ in range(count)]


def play(env: SceneEnv, actions: Sequence[Any], seed: int = SEED) -> ScenePlay:
    """Reset an environment with a seed and take the actions; reset it again when an episode ends.

    Raises:
        TltlError: TLT0781, the game raises an exception.
    """
    start = time.perf_counter()
    observation, _ = env.reset(seed=seed)
    moments = [_moment(env, 0, observation, ended=False)]
    moments += go_on(env, actions)
    return ScenePlay(tuple(moments), time.perf_counter() - start)


def go_on(env: SceneEnv, actions: Sequence[Any]) -> list[PlayedMoment]:
    """Take actions from the present state on; return the moments after each step and each reset.

    The environment is reset when an episode ends.

    Raises:
        TltlError: TLT0781, the game raises an exception.
    """
    moments = []
    for step, action in enumerate(actions, 1):
        observation, _, terminated, truncated, _ = env.step(action)
        ended = bool(terminated or truncated)
        moments.append(_moment(env, step, observation, ended=ended))
        if ended:
            observation, _ = env.reset()
            moments.append(_moment(env, step, observation, ended=False))
    return moments


def first_difference(first: Sequence[PlayedMoment], second: Sequence[PlayedMoment]) -> PlayDifference | None:
    """Return the first difference between two plays, in a signal or in the end of an episode; None without one."""
    for one, other in zip(first, second, strict=False):
        if one.ended != other.ended:
            return PlayDifference(one.step, "", one.ended, other.ended)
        name = other_name(one.sample, other.sample)
        if name is not None:
            return PlayDifference(one.step, name, one.sample.get(name), other.sample.get(name))
    return None


def first_other_observation(first: Sequence[PlayedMoment], second: Sequence[PlayedMoment]) -> int | None:
    """Return the first step after which the observations of two plays differ; None if there is none."""
    pairs = zip(first, second, strict=False)
    return next((one.step for one, other in pairs if not is_same(one.observation, other.observation)), None)


def _moment(env: SceneEnv, step: int, observation: Any, *, ended: bool) -> PlayedMoment:
    return PlayedMoment(step, copied(observation), copied(env.tltl_signals()), ended)
