"""Episodes of the scripted expert. The processes of a test run play an episode once, and share it as a file."""

from __future__ import annotations

import os
from contextlib import closing
from functools import cache
from pathlib import Path

from filelock import FileLock

from tltl_runtime.stealth.env import make_env
from tltl_runtime.stealth.episode_recorder import RecordEpisode
from tltl_runtime.stealth.expert.expert import Expert, play_episode
from tltl_runtime.stealth.recordings.episode import Episode
from tltl_runtime.stealth.recordings.file import read_episode, write_episode


def played(level: str, variant: str = "v0", seed: int = 0, *, careful: bool = True) -> Episode:
    """Return the episode of a ``seed``, played by the ``careful`` or the careless expert.

    Tests share the episode, so they must only read it.
    """
    return _played(level, variant, seed, careful)


@cache
def _played(level: str, variant: str, seed: int, careful: bool) -> Episode:
    path = Path(os.environ["TLTLC_TESTS_SHARED"], f"{level}-{variant}-{seed}-{careful}.episode.npz")
    with FileLock(f"{path}.lock"):
        if not path.exists():
            write_episode(path, _play(level, variant, seed, careful))
        return read_episode(path)


def _play(level: str, variant: str, seed: int, careful: bool) -> Episode:
    with closing(RecordEpisode(make_env(level, variant), "expert")) as env:
        play_episode(env, Expert(env, careful=careful), seed)
        return env.episode
