"""Demonstrations without the expert, and trainings that imitate them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from tests.runtime.training.runs import run_in
from tltl_runtime.game.recording_path import file_stem, new_path
from tltl_runtime.stealth.env import make_env
from tltl_runtime.stealth.episode_recorder import RecordEpisode
from tltl_runtime.stealth.recordings.episode import Episode
from tltl_runtime.stealth.recordings.file import write_episode
from tltl_runtime.training.files.run_file import TrainingRun
from tltlc.core.record import replace

SOON = "import stealth\nspec soon { level cover_and_hide\n limit 8 steps\n keep alive }\n"
"""A spec that every policy meets after eight steps."""
ALONG = 1, 0, 0, 0, 1
"""The action of a demonstration: run towards greater x."""


def recorded_episode(
    seed: int, spec: str = SOON, variant: str = "v0", steps: int = 8, action: Sequence[int] = ALONG, player: str = "me"
) -> Episode:
    """Return an episode that repeats one action and stops after ``steps`` steps."""
    env = RecordEpisode(make_env("cover_and_hide", variant, spec), player)
    env.reset(seed=seed)
    for _ in range(steps):
        env.step(list(action))
    env.close()
    return env.episode


def write_recordings(folder: Path, *episodes: Episode) -> Path:
    """Write recordings of the episodes into ``folder``; return the folder."""
    folder.mkdir(exist_ok=True)
    for episode in episodes:
        write_episode(new_path(folder, file_stem(episode)), episode)
    return folder


def imitating(folder: Path, demonstrations: Path | None, **changes: Any) -> TrainingRun:
    """Return a training by imitation of three iterations.

    In the first iteration, the actor is cloned from the ``demonstrations``, or from the expert if
    they are None. ``changes`` are those of :func:`run_in`.
    """
    run = run_in(folder, SOON, **{"method": "imitation", "imitation__cloning": 0.3, **changes})
    return replace(run, demonstrations=str(demonstrations) if demonstrations else None)
