"""The trajectory of an episode, small enough to keep hundreds of them in memory."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.spec.episode_summary import End
from tltl_runtime.stealth.recordings.episode import Episode
from tltlc.api import record


@record
class Trajectory:
    """The player's path, the automaton's states, and the end.

    ``points`` is (n + 1, 2), in metres; ``states`` is (n + 1,).
    """

    points: NDArray[np.float32]
    states: NDArray[np.int32]
    end: End


def trajectory(episode: Episode) -> Trajectory:
    """Extract the trajectory of an episode."""
    points = np.array([shot.player.position[:2] for shot in episode.snapshots], dtype=np.float32)
    return Trajectory(points, episode.states, episode.end)
