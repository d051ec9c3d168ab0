"""The trajectory of a recorded episode."""

from __future__ import annotations

import numpy as np

from tltl_runtime.game.episode import Trajectory
from tltl_runtime.stealth.recordings.episode import Episode


def trajectory(episode: Episode) -> Trajectory:
    """Extract the trajectory of an episode."""
    points = np.array([shot.player.position[:2] for shot in episode.snapshots], dtype=np.float32)
    return Trajectory(points, episode.states, episode.end)
