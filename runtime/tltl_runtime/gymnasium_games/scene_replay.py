"""Play recorded episodes of scenes again."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing
from typing import Any

import gymnasium

from tltl_runtime.evaluation.versions import versions
from tltl_runtime.game.recorder import judging_wrapper
from tltl_runtime.game.recording_check import replay_difference
from tltl_runtime.gymnasium_games.scene_episode import SceneEpisode
from tltl_runtime.policies.spaces.action_layout import action_layout
from tltl_runtime.policies.spaces.values import action_value
from tltlc.api import Diagnostic, TltlError


def check_replay(episode: SceneEpisode) -> tuple[Diagnostic, ...]:
    """Play the actions of an episode again, and compare the signals of the spec and the end.

    Return the diagnostic TLT0824 if they differ, else an empty tuple. ``episode.level.place`` must say
    where the scene is.

    Raises:
        TltlError: the errors of :func:`replayed_env`; the game raises an exception.
    """
    with closing(replayed_env(episode)) as env:
        difference = next(filter(None, play_again(env, episode)), None)
    return () if difference is None else (difference,)


def replayed_env(episode: SceneEpisode, render_mode: str | None = None) -> gymnasium.Env[Any, Any]:
    """Make the environment in which an episode was recorded; ``episode.level.place`` must say where its scene is.

    Raises:
        TltlError: the errors of making the environment; TLT0822, the actions of the recording are not
            those of the environment.
    """
    level = episode.level
    env = level.game.make_env(
        level.place, level.variant, episode.fspa, params=dict(episode.params), render_mode=render_mode
    )
    if action_layout(env.action_space) != episode.layout:
        env.close()
        title = f"the recording has other actions than the scene `{level.name}` has now"
        raise TltlError([Diagnostic("TLT0822", title, help="record the episode again")])
    return env


def play_again(env: gymnasium.Env[Any, Any], episode: SceneEpisode) -> Iterator[Diagnostic | None]:
    """Reset an environment with the seed of an episode and take its actions.

    After the reset and after each step, yield None, or the diagnostic TLT0824 if a signal of the spec
    differs from the recording, or if the episode ends at another step.
    """
    names, judge = [signal.name for signal in episode.fspa.signals], judging_wrapper(env)
    env.reset(seed=episode.seed)
    for row, signals in enumerate(episode.signals.tolist()):
        if row:
            env.step(action_value(episode.layout, episode.actions[row - 1]))
        is_over = judge.taken is not None and judge.taken.done
        ends = row == len(episode.actions) and episode.end != "stopped"
        is_same = [float(judge.sample[name]) for name in names] == signals and is_over == ends
        yield None if is_same else replay_difference(episode, row, versions())
