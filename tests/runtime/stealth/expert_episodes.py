"""Episodes of the scripted expert. Each process plays an episode once."""

from __future__ import annotations

from contextlib import closing
from functools import cache

from tltl_runtime.stealth.env import make_env
from tltl_runtime.stealth.episode_recorder import RecordEpisode
from tltl_runtime.stealth.expert.expert import Expert, play_episode
from tltl_runtime.stealth.recordings.episode import Episode


def played(level: str, variant: str = "v0", seed: int = 0, *, careful: bool = True) -> Episode:
    """Return the episode of a ``seed``, played by the ``careful`` or the careless expert.

    Tests share the episode, so they must only read it.
    """
    return _played(level, variant, seed, careful)


@cache
def _played(level: str, variant: str, seed: int, careful: bool) -> Episode:
    with closing(RecordEpisode(make_env(level, variant), "expert")) as env:
        play_episode(env, Expert(env, careful=careful), seed)
        return env.episode
