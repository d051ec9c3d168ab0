"""The cameras of the views, and the projection between pixels and the world."""

from __future__ import annotations

from math import cos, hypot, sin, tan
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.stealth.level import Point, StealthLevel
from tltlc.api import record

View = Literal["third_person", "top_down", "overview"]
VIEWS: tuple[View, ...] = ("third_person", "top_down", "overview")

FilmView = Literal["third_person", "top_down", "overview", "plan"]
FILM_VIEWS: tuple[FilmView, ...] = (*VIEWS, "plan")

SMALLEST, LARGEST = 16, 4096
"""The least and the greatest side of a picture, in pixels.

Outside this range, pybullet ends the process.
"""

_FOLLOW = (0.0, -6.6, 8.4)
"""The vector from the player's feet to the camera that follows the player, in metres.

The camera is to the south and above, so that north is up in every view.
"""
_AHEAD = (0.0, 0.6, 0.6)
"""The vector from the player's feet to the point at which that camera looks, in metres."""
_FIELD = 50.0
_TOP_FIELD = 8.0
"""The field of view from above, in degrees.

It is narrow, and the camera far away, so that walls hardly lean outwards.
"""
_MARGIN = 1.03
_OVERVIEW_FIELD = 40.0
_EDGE = 0.015
"""The fraction of the overview that stays free at each side."""
_OBLIQUE = 1.05
"""The height of the overview camera, as a multiple of its horizontal distance from the middle."""


@record
class Camera:
    """A camera that looks from ``eye`` to ``target``; its field of view is ``field`` degrees high.

    Lengths are in metres. ``up`` is the direction that is up in the picture. Pictures show what is
    between the distances ``near`` and ``far``.
    """

    eye: Point
    target: Point
    field: float
    up: Point = (0.0, 0.0, 1.0)
    near: float = 0.5
    far: float = 150.0


def camera(level: StealthLevel, view: View, player: Point, aspect: float) -> Camera:
    """Return the camera of a view.

    ``aspect`` is the picture's width divided by its height, ``player`` the position of the player's
    feet. The view ``third_person`` follows the player from the south. The views ``top_down`` and
    ``overview`` (from the south, oblique) show the entire level.
    """
    if view == "third_person":
        return Camera(_add(player, _FOLLOW), _add(player, _AHEAD), _FIELD)
    if view == "top_down":
        return _top_down(level, aspect)
    return _overview(level, aspect)


def check_size(size: object) -> tuple[int, int]:
    """Return ``size`` if it is a valid width and height of a picture, in pixels.

    Raises ValueError unless ``size`` is two whole numbers from 16 to 4096.
    """
    match size:
        case (int(width), int(height)) if all(SMALLEST <= side <= LARGEST for side in (width, height)):
            return width, height
    raise ValueError(
        f"a picture's size must be (width, height) in pixels, each from {SMALLEST} to {LARGEST}, not {size!r}"
    )


def sight_lines(camera: Camera, width: int, height: int) -> NDArray[np.float32]:
    """Return for each pixel the vector from the camera towards what the pixel shows.

    Each vector is so long that it advances one metre along the direction of view. The result is
    (height, width, 3).
    """
    ahead, right, up = _axes(camera)
    half = tan(np.radians(camera.field) / 2)
    x = (2 * (np.arange(width) + 0.5) / width - 1) * half * width / height
    y = (1 - 2 * (np.arange(height) + 0.5) / height) * half
    rows = (ahead + y[:, None] * up).astype(np.float32)
    columns = (x[:, None] * right).astype(np.float32)
    lines: NDArray[np.float32] = rows[:, None] + columns
    return lines


def pixels(camera: Camera, points: NDArray[np.float64], width: int, height: int) -> NDArray[np.float64]:
    """Project points (n, 3) to pixels (n, 2), counted from the upper left corner of the picture.

    All points must be in front of the camera.
    """
    ahead, right, up = _axes(camera)
    offsets = points - np.array(camera.eye)
    half = tan(np.radians(camera.field) / 2)
    depth = np.maximum(offsets @ ahead, camera.near)
    x = offsets @ right / depth / (half * width / height)
    y = offsets @ up / depth / half
    return np.stack([(x + 1) / 2 * width, (1 - y) / 2 * height], axis=1)


def _top_down(level: StealthLevel, aspect: float) -> Camera:
    """Return a camera above the level, so high that the floor and the tops of the walls fit.

    ``aspect`` is the picture's width divided by its height.
    """
    low, high = level.bounds.low, level.bounds.high
    x, y = (low[0] + high[0]) / 2, (low[1] + high[1]) / 2
    needed = max(high[1] - low[1], (high[0] - low[0]) / aspect) * _MARGIN
    eye = (x, y, high[2] + needed / 2 / tan(np.radians(_TOP_FIELD) / 2))
    return Camera(eye, (x, y, 0.0), _TOP_FIELD, up=(0.0, 1.0, 0.0), near=eye[2] - high[2] - 1, far=eye[2] + 5)


def _overview(level: StealthLevel, aspect: float) -> Camera:
    """Return a camera to the south and above, as near as it can be to show the whole level.

    ``aspect`` is the picture's width divided by its height.
    """
    low, high = level.bounds.low, level.bounds.high
    x, y = (low[0] + high[0]) / 2, (low[1] + high[1]) / 2
    corners = np.array([(a, b, c) for a in (low[0], high[0]) for b in (low[1], high[1]) for c in (0.0, high[2])])
    size = hypot(high[0] - low[0], high[1] - low[1])
    for away in np.arange(size * 0.4, size * 4, size * 0.02).tolist():
        eye = (x, y - away, away * _OBLIQUE)
        # The vertical position of a corner depends on its angle only: aim at the middle of the angles.
        angles = np.arctan2(corners[:, 2] - eye[2], corners[:, 1] - eye[1])
        ahead = float(angles.min() + angles.max()) / 2
        candidate = Camera(eye, (x, eye[1] + cos(ahead), eye[2] + sin(ahead)), _OVERVIEW_FIELD, far=away * 4)
        positions = pixels(candidate, corners, 1000, round(1000 / aspect)) / (1000, 1000 / aspect)
        if positions.min() >= _EDGE and positions.max() <= 1 - _EDGE:
            break
    return candidate


def _axes(camera: Camera) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    ahead = np.subtract(camera.target, camera.eye)
    ahead = ahead / np.linalg.norm(ahead)
    right = np.cross(ahead, camera.up)
    right = right / np.linalg.norm(right)
    return ahead, right, np.cross(right, ahead)


def _add(a: Point, b: Point) -> Point:
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]
