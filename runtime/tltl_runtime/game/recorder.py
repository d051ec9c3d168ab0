"""An environment that records the episodes that are played in it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Generic, TypeVar

import gymnasium

from tltl_runtime.game.episode import RecordedEpisode
from tltl_runtime.spec.episode_summary import End, settled_end
from tltl_runtime.spec.wrapper import TltlEnv
from tltlc.api import Step

EpisodeT = TypeVar("EpisodeT", bound=RecordedEpisode)


class EpisodeRecorder(gymnasium.Wrapper[Any, Any, Any, Any], Generic[EpisodeT]):
    """A wrapper that records the current episode. Observations, rewards and infos pass through unchanged.

    The wrapped environment is a :class:`~tltl_runtime.spec.wrapper.TltlEnv` over a game, or
    wrappers around one.
    """

    @property
    def episode(self) -> EpisodeT:
        """A copy of the episode so far; raises RuntimeError before the first reset."""
        raise NotImplementedError


def closing_on_error(
    env: gymnasium.Env[Any, Any], wrap: Callable[[gymnasium.Env[Any, Any]], EpisodeRecorder[EpisodeT]]
) -> EpisodeRecorder[EpisodeT]:
    """Return ``wrap(env)``; close the environment if this raises an error, because nobody else could."""
    try:
        return wrap(env)
    except BaseException:
        env.close()
        raise


def judging_wrapper(env: gymnasium.Env[Any, Any]) -> TltlEnv:
    """Return the outermost :class:`TltlEnv` in ``env``; raises TypeError if there is none."""
    layer: gymnasium.Env[Any, Any] = env
    while not isinstance(layer, TltlEnv):
        if not isinstance(layer, gymnasium.Wrapper):
            raise TypeError("a recording needs a spec that judges the episode: wrap the game in TltlEnv first")
        layer = layer.env
    return layer


def recorded_step_s(env: gymnasium.Env[Any, Any]) -> float:
    """Return how long a step takes in summaries and recordings, in seconds: ``tltl_clock_s`` of ``env``.

    It is 1 if the environment has no clock.
    """
    return float(env.get_wrapper_attr("tltl_clock_s")) if env.has_wrapper_attr("tltl_clock_s") else 1.0


def recorded_end(last: Step | None, success: bool) -> End:
    """Return how an episode ended; ``last`` is its last step, or None if it has no steps.

    ``success`` says whether the episode met the spec. The result is ``stopped`` if it was still going.
    """
    if last is None or not last.done:
        return "stopped"
    return settled_end(success, last.verdict)
