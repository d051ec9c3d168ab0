"""The trajectory of an episode: little enough to keep hundreds of them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.stealth.recordings.episode import End, Episode
from tltlc.core.record import record


@record
class Trajectory:
    """Where the player went: ``points`` (n + 1, 2) in metres, ``states`` (n + 1,) of the automaton, how it ended."""

    points: NDArray[np.float32]
    states: NDArray[np.int32]
    end: End


def trajectory(episode: Episode) -> Trajectory:
    """The trajectory of an episode."""
    points = np.array([shot.player.position[:2] for shot in episode.snapshots], dtype=np.float32)
    return Trajectory(points, episode.states, episode.end)
