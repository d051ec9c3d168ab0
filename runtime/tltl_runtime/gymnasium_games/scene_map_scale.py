"""The scale of the map of a scene."""

from __future__ import annotations

from typing import Final

from tltl_runtime.game.geometry import Box
from tltl_runtime.gymnasium_games.scene_level import SceneLevel

_LONGEST_SIDE_M: Final = 20.0
"""The longer side of the map of a scene, in metres of the map: names and marks are made for about this size."""


def scene_metre(level: SceneLevel) -> float:
    """Return how many metres of a scene a metre on its map stands for; 1 if the scene has no bounds."""
    return 1.0 if level.bounds is None else scale_of(level.bounds)


def scale_of(bounds: Box) -> float:
    """Return how many metres of a scene with these ``bounds`` a metre on its map stands for."""
    (west, south, _), (east, north, _) = bounds.low, bounds.high
    return max(east - west, north - south) / _LONGEST_SIDE_M
