"""The scale of the map of a scene."""

from __future__ import annotations

from typing import Final

from tltl_runtime.game.geometry import Box
from tltl_runtime.gymnasium_games.scene_level import SceneLevel

_LONGEST_SIDE_M: Final = 20.0
"""The longer side of the map of a scene, in metres of the map: names and marks are made for about this size."""


def scene_metre(level: SceneLevel) -> float:
    """Return the length in a scene that is a metre on its map; 1 if the game does not say where things are."""
    return 1.0 if level.bounds is None else scale_of(level.bounds)


def scale_of(bounds: Box) -> float:
    """Return the length in a scene with these ``bounds`` that is a metre on its map."""
    (west, south, _), (east, north, _) = bounds.low, bounds.high
    return max(east - west, north - south) / _LONGEST_SIDE_M
