"""Episodes of the scripted expert, each played once in a process."""

from __future__ import annotations

from contextlib import closing
from functools import cache

from tltl_runtime.stealth.env import make_env
from tltl_runtime.stealth.episode_recorder import RecordEpisode
from tltl_runtime.stealth.expert.expert import Expert, play_episode
from tltl_runtime.stealth.recordings.episode import Episode


def played(level: str, variant: str = "v0", seed: int = 0, *, careful: bool = True) -> Episode:
    """The episode of a seed, played by the careful or the careless expert; it must only be read."""
    return _played(level, variant, seed, careful)


@cache
def _played(level: str, variant: str, seed: int, careful: bool) -> Episode:
    with closing(RecordEpisode(make_env(level, variant), "expert")) as env:
        play_episode(env, Expert(env, careful=careful), seed)
        return env.episode
