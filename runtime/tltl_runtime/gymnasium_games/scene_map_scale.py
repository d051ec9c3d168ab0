"""The scale of the map of a scene."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.game.geometry import Box
from tltl_runtime.gymnasium_games.scene_level import SceneLevel

_LONGEST_SIDE_M: Final = 20.0
"""The longer side of the map of a scene, in metres of the map: names and marks are made for about this size."""

_MARGIN: Final = 0.05
"""The margin around points of a plan without an outline, as a share of the longer side."""


def bounds_around(points: NDArray[np.float64]) -> Box:
    """Return the bounds of a plan that shows these points, (n, 2), in metres, with a margin around them."""
    low, high = points.min(axis=0), points.max(axis=0)
    margin = _MARGIN * max(1.0, float((high - low).max()))
    (west, south), (east, north) = (low - margin).tolist(), (high + margin).tolist()
    return Box((west, south, 0.0), (east, north, 1.0))


def scene_metre(level: SceneLevel) -> float:
    """Return how many metres of a scene a metre on its map stands for; 1 if the scene has no bounds."""
    return 1.0 if level.bounds is None else scale_of(level.bounds)


def scale_of(bounds: Box) -> float:
    """Return how many metres of a scene with these ``bounds`` a metre on its map stands for."""
    (west, south, _), (east, north, _) = bounds.low, bounds.high
    return max(east - west, north - south) / _LONGEST_SIDE_M
