"""The part of the floor that an enemy sees, for pictures only.

In play, :mod:`~tltl_runtime.stealth.enemies.enemy` decides whether an enemy sees the player.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import pi

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.stealth.enemies.enemy import CROUCHED_HEAD, EYES, STANDING_HEAD
from tltl_runtime.stealth.level import Box, EnemyKind, Point

_ANGLES = 128
_RINGS = 64
_ONLY_STANDING = 0.5


class SightField:
    """The visibility of a player to an enemy, at each position on the floor.

    The value is 1 where the enemy would see even a crouched player, 0.5 where it would see only a
    standing one, and 0 elsewhere. ``feet`` and ``yaw`` are the enemy's pose. ``boxes`` block its
    sight.
    """

    def __init__(self, kind: EnemyKind, feet: Point, yaw: float, boxes: Iterable[Box]) -> None:
        self.eyes = (feet[0], feet[1], feet[2] + EYES)
        self.reach = kind.sight_range
        self.yaw = yaw
        self.half = min(kind.sight_angle, 2 * pi) / 2
        near = [box for box in boxes if _is_near(box, self.eyes, self.reach)]
        angles = yaw + np.linspace(-self.half, self.half, _ANGLES)
        radii = (np.arange(_RINGS) + 0.5) / _RINGS * self.reach
        x, y = np.cos(angles)[:, None] * radii, np.sin(angles)[:, None] * radii
        standing = self._free(x, y, feet[2] + STANDING_HEAD, near)
        crouched = self._free(x, y, feet[2] + CROUCHED_HEAD, near)
        self._seen = np.where(crouched, 1.0, np.where(standing, _ONLY_STANDING, 0.0)).astype(np.float32)

    def visibility(self, places: NDArray[np.float32]) -> NDArray[np.float32]:
        """Return how well the enemy would see players at positions (n, 2), as (n,) in [0, 1].

        The values are 0, 0.5 (only a standing player) or 1; at borders between them, they are
        interpolated.
        """
        x, y = places[:, 0] - np.float32(self.eyes[0]), places[:, 1] - np.float32(self.eyes[1])
        radius = np.hypot(x, y)
        angle = (np.arctan2(y, x) - self.yaw + pi) % (2 * pi) - pi
        row = (angle + self.half) / (2 * self.half) * (_ANGLES - 1)
        ring = radius / self.reach * _RINGS - 0.5
        visibility = _interpolate(self._seen, row, ring)
        inside = (np.abs(angle) <= self.half) & (radius < self.reach)
        return np.where(inside, visibility, np.float32(0.0))

    def _free(
        self, x: NDArray[np.float64], y: NDArray[np.float64], head: float, boxes: Iterable[Box]
    ) -> NDArray[np.bool_]:
        """Return for each offset ``x``, ``y`` from the enemy's eyes whether the enemy sees a head there.

        ``head`` is the height of the head, in metres; ``boxes`` block the sight.
        """
        free = np.ones(x.shape, np.bool_)
        for box in boxes:
            enter, leave = np.zeros(x.shape), np.ones(x.shape)
            for axis, delta in enumerate((x, y, np.full(x.shape, head - self.eyes[2]))):
                with np.errstate(divide="ignore", invalid="ignore"):
                    low_time = (box.low[axis] - self.eyes[axis]) / delta
                    high_time = (box.high[axis] - self.eyes[axis]) / delta
                enter = np.maximum(enter, np.minimum(low_time, high_time))
                leave = np.minimum(leave, np.maximum(low_time, high_time))
            free &= enter >= leave
        return free


def _interpolate(
    table: NDArray[np.float32], row: NDArray[np.float32], column: NDArray[np.float32]
) -> NDArray[np.float32]:
    """Interpolate a table bilinearly at fractional rows and columns, so that shadows are soft."""
    rows, columns = table.shape
    row, column = row.clip(0, rows - 1.001), column.clip(0, columns - 1.001)
    i, j = row.astype(np.int32), column.astype(np.int32)
    a, b = (row - i).astype(np.float32), (column - j).astype(np.float32)
    near = table[i, j] * (1 - b) + table[i, j + 1] * b
    far = table[i + 1, j] * (1 - b) + table[i + 1, j + 1] * b
    return np.asarray(near + (far - near) * a, np.float32)


def _is_near(box: Box, eyes: Point, reach: float) -> bool:
    return box.high[2] > 0.0 and all(box.low[axis] - reach < eyes[axis] < box.high[axis] + reach for axis in (0, 1))
