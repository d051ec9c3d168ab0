"""Play a scene with random actions, and compare two plays."""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping, Sequence
from copy import deepcopy
from itertools import pairwise
from typing import Any, Final

from tltl_runtime.gymnasium_games.scene_env import SceneEnv
from tltl_runtime.support.same_values import copied, is_same, other_name
from tltl_runtime.wire.errors import WireError
from tltlc.api import Diagnostic, record

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
    """A play: its moments, including those after resets, and how many seconds it took.

    ``loss`` says what happened if the game, in another process, was lost, which ended the play.
    """

    moments: tuple[PlayedMoment, ...]
    seconds: float
    loss: Diagnostic | None = None

    @property
    def steps(self) -> int:
        """The number of steps that were played."""
        return self.moments[-1].step if self.moments else 0


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

    The play ends early if the game is lost.

    Raises:
        TltlError: TLT0781, the game raises an exception.
    """
    start, moments, loss = time.perf_counter(), list[PlayedMoment](), None
    try:
        observation, _ = env.reset(seed=seed)
        moments.append(_moment(env, 0, observation, ended=False))
        for moment in _moments(env, actions):
            moments.append(moment)
    except WireError as error:
        loss = error.diagnostics[0]
    return ScenePlay(tuple(moments), time.perf_counter() - start, loss)


def go_on(env: SceneEnv, actions: Sequence[Any]) -> list[PlayedMoment]:
    """Take actions from the present state on; return the moments after each step and each reset.

    The environment is reset when an episode ends.

    Raises:
        TltlError: TLT0781, the game raises an exception; the errors of a game in another process.
    """
    return [*_moments(env, actions)]


def _moments(env: SceneEnv, actions: Sequence[Any]) -> Iterator[PlayedMoment]:
    for step, action in enumerate(actions, 1):
        observation, _, terminated, truncated, _ = env.step(action)
        ended = bool(terminated or truncated)
        yield _moment(env, step, observation, ended=ended)
        if ended:
            observation, _ = env.reset()
            yield _moment(env, step, observation, ended=False)


def unchanged_signals(moments: Sequence[PlayedMoment]) -> list[str]:
    """Return the names of the signals that no step has changed; a reset may have changed them."""
    steps = [(one.sample, other.sample) for one, other in pairwise(moments) if not one.ended]
    names = map(str, moments[0].sample) if steps else ()
    return [name for name in names if all(is_same(one.get(name), other.get(name)) for one, other in steps)]


def observation_changes(moments: Sequence[PlayedMoment]) -> bool:
    """Whether some step has changed the observation."""
    return any(not is_same(one.observation, other.observation) for one, other in pairwise(moments) if not one.ended)


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
