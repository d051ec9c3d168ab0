"""Paint layers over a picture: a floor pattern, fields of sight, glass, background.

The depth of a pixel tells which position in the world the pixel shows. A layer is painted over the
pixels whose positions it covers. Pictures contain floats in [0, 1].
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.stealth.level import Point
from tltl_runtime.stealth.rendering.camera import Camera, pixels, sight_lines
from tltl_runtime.stealth.rendering.cone import SightField

Floats = NDArray[np.float32]
Mask = NDArray[np.bool_]
PixelRegion = tuple[slice, slice]
"""Rows and columns of a picture."""

_BEHIND = np.array((0.118, 0.141, 0.196), np.float32)
_BEHIND_TOP = np.array((0.224, 0.259, 0.345), np.float32)
_TILE = 2.0
_TILE_SHADE = 0.955
_EDGE_SHADE = 0.62
_FACES = np.array((0.85, 0.7, 1.0), np.float32)
"""The brightness of the sides of a glass box: those along x, those along y, and the top."""


class Canvas:
    """A picture (height, width, 3) from ``camera``, with the depth of its pixels (height, width).

    The depth is in metres along the direction of view.
    """

    def __init__(self, picture: Floats, depth: Floats, camera: Camera) -> None:
        self.picture = picture
        self.depth = depth
        self.camera = camera
        self.height, self.width = depth.shape
        self.lines = sight_lines(camera, self.width, self.height)
        self.places = np.array(camera.eye, np.float32) + self.lines * depth[..., None]
        """The position in the world that each pixel shows, (height, width, 3)."""

    def tiles(self, floor: Mask) -> None:
        """Paint a chequered pattern of 2 m tiles where ``floor`` is true."""
        rows, columns = np.nonzero(floor)
        tile = np.floor(self.places[rows, columns, :2] / np.float32(_TILE)).sum(axis=1)
        self.picture[rows, columns] *= np.where(tile % 2 == 1, np.float32(_TILE_SHADE), np.float32(1.0))[:, None]

    def edges(self, bodies: NDArray[np.int32]) -> None:
        """Draw thin dark lines where bodies meet in the picture.

        ``bodies`` [height, width] has the number of the body at each pixel.
        """
        edge = np.zeros(bodies.shape, np.bool_)
        edge[:, 1:] |= bodies[:, 1:] != bodies[:, :-1]
        edge[1:] |= bodies[1:] != bodies[:-1]
        self.picture[edge] *= _EDGE_SHADE

    def background(self, empty: Mask) -> None:
        """Paint the background where ``empty`` is true; it is lighter towards the top."""
        rows, columns = np.nonzero(empty)
        share = (1 - rows / self.height).astype(np.float32)[:, None]
        self.picture[rows, columns] = _BEHIND + share * (_BEHIND_TOP - _BEHIND)

    def shadow(self, feet: Point, radius: float) -> None:
        """Paint a soft round shadow on the surface below a body's feet."""
        x, y, z = feet
        region = self._region([(x + a, y + b, z) for a in (-radius, radius) for b in (-radius, radius)])
        places = self.places[region]
        off = np.hypot(places[..., 0] - x, places[..., 1] - y) / radius
        below = np.abs(places[..., 2] - z) < 0.35
        self.picture[region] *= (1 - 0.45 * np.clip(1 - off**2, 0, 1) * below)[..., None]

    def field(self, field: SightField, colour: Sequence[float], strength: float) -> None:
        """Paint the part of the floor that an enemy sees, in this ``colour`` and ``strength``.

        ``strength`` is the opacity, in [0, 1]. It is half where the enemy sees only standing
        players.
        """
        x, y, _ = field.eyes
        reach = field.reach
        region = self._region([(x + a, y + b, 0.0) for a in (-reach, reach) for b in (-reach, reach)])
        places = self.places[region]
        on_floor = np.abs(places[..., 2]) < 0.06
        seen = np.zeros(on_floor.shape, np.float32)
        seen[on_floor] = field.visibility(places[on_floor][:, :2])
        self._blend(region, np.array(colour, np.float32), strength * seen)

    def glass(self, low: Point, high: Point, colour: Sequence[float], strength: float) -> None:
        """Paint a translucent box with the corners ``low`` and ``high``; bodies in front of the box hide it.

        ``strength`` is the opacity, in [0, 1].
        """
        corners = [(x, y, z) for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])]
        region = self._region(corners)
        lines = self.lines[region]
        eye = np.array(self.camera.eye, np.float32)
        with np.errstate(divide="ignore", invalid="ignore"):
            low_time, high_time = (np.array(low, np.float32) - eye) / lines, (np.array(high, np.float32) - eye) / lines
        enters = np.minimum(low_time, high_time)
        enter, leave = enters.max(axis=-1), np.maximum(low_time, high_time).min(axis=-1)
        met = (enter < leave) & (leave > 0) & (enter < self.depth[region] + 0.02)
        face = _FACES[enters.argmax(axis=-1)]
        self._blend(region, np.array(colour, np.float32) * face[..., None], strength * met)

    def _blend(self, region: PixelRegion, colour: Floats, share: Floats) -> None:
        share = share[..., None].astype(np.float32)
        self.picture[region] = self.picture[region] * (1 - share) + colour * share

    def _region(self, points: Sequence[Point]) -> PixelRegion:
        """Return the smallest rectangle of the picture that shows all these points, as rows and columns."""
        positions = pixels(self.camera, np.array(points, np.float64), self.width, self.height)
        left, top = np.floor(positions.min(axis=0)).astype(int)
        right, bottom = np.ceil(positions.max(axis=0)).astype(int) + 1
        return slice(max(top, 0), max(bottom, 0)), slice(max(left, 0), max(right, 0))
