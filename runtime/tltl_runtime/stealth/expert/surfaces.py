"""The places where a player can stand: the tops of all boxes, cell by cell.

The ground plan of a level is cut into square cells. Each height at which a box ends is a layer. A
place is a cell in a layer: the centre of the cell lies on the top of a box at this height, and
there is room for the body above it. An upright cylinder approximates the body.
"""

from __future__ import annotations

from collections.abc import Collection
from math import ceil
from typing import Final

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.stealth.level import Box, Point, StealthLevel
from tltl_runtime.stealth.world.player import PlayerKind

CELL: Final = 0.25
"""The side of a cell, in metres."""

Cells = NDArray[np.bool_]
"""A mask of cells, [layers, rows, columns]; rows run along y, columns along x."""

_TOUCH: Final = 1e-6


class Surfaces:
    """The places of a level where a player can stand while the barriers with the indices ``shut`` are shut.

    ``heights`` [layers] are the heights of the tops, upwards; ``xs`` [columns] and ``ys`` [rows]
    are the centres of the cells, all in metres. These masks say for each cell in each layer:

    - ``places``: whether the player can stand there, at least crouched: the cell is on top of a box.
    - ``standing``: whether a standing body has room above it.
    - ``crouched``: whether a crouched body has room above it.
    - ``leaping``: whether a body that jumps upright has room above it.

    Room includes ``margin`` metres to all sides. Shut lasers count as obstacles, but boxes no
    higher than a stair do not.
    """

    def __init__(self, level: StealthLevel, shut: Collection[int] = (), *, margin: float = 0.04) -> None:
        self.kind = PlayerKind()
        (x0, y0, _), (x1, y1, ceiling) = level.bounds.low, level.bounds.high
        self.origin = (x0, y0)
        columns, rows = ceil((x1 - x0) / CELL - _TOUCH), ceil((y1 - y0) / CELL - _TOUCH)
        self.xs = x0 + CELL * (np.arange(columns) + 0.5)
        self.ys = y0 + CELL * (np.arange(rows) + 0.5)
        solids = [solid.box for solid in level.solids]
        barriers = [level.barriers[index] for index in sorted(shut)]
        boxes = solids + [barrier.box for barrier in barriers]
        grounds = solids + [barrier.box for barrier in barriers if barrier.kind == "solid"]
        self.heights = np.array(sorted({box.high[2] for box in grounds if box.high[2] < ceiling - _TOUCH}))
        apex = self.kind.jump_speed**2 / (2 * self.kind.gravity)
        self.standing = self._free(boxes, self.kind.height, margin)
        self.crouched = self._free(boxes, self.kind.crouched_height, margin)
        self.leaping = self._free(boxes, self.kind.height + apex, margin)
        self.places: Cells = self._supported_cells(grounds) & self.crouched & ~self._buried_cells(boxes)
        layer, row, column = np.nonzero(self.places)
        self._flat = np.flatnonzero(self.places)
        self._points = np.stack([self.xs[column], self.ys[row], self.heights[layer]], axis=1)

    def near(self, point: Point, radius: float) -> NDArray[np.intp]:
        """Return the places within ``radius`` metres of a point, as flat indices into ``places``."""
        return self._flat[self._squares(point) <= radius * radius]

    def nearest(self, point: Point) -> int:
        """Return the place nearest to a point, as a flat index into ``places``."""
        return int(self._flat[self._squares(point).argmin()])

    def point(self, place: int) -> Point:
        """Return the position of a place: the centre of its cell, on the ground. ``place`` is its flat index."""
        layer, row, column = np.unravel_index(place, self.places.shape)
        return float(self.xs[column]), float(self.ys[row]), float(self.heights[layer])

    def _squares(self, point: Point) -> NDArray[np.float64]:
        """Return the squared distances of all places from a point."""
        squares: NDArray[np.float64] = ((self._points - np.array(point)) ** 2).sum(axis=1)
        return squares

    def _supported_cells(self, boxes: list[Box]) -> Cells:
        supported = self._no_cells()
        for box in boxes:
            layer = np.flatnonzero(np.abs(self.heights - box.high[2]) < _TOUCH)
            rows, columns = self._over(box)
            supported[layer] |= (rows[:, None] & columns[None, :])[None]
        return supported

    def _free(self, boxes: list[Box], height: float, margin: float) -> Cells:
        """Return a mask of the cells above which an upright cylinder of this ``height`` is free.

        The cylinder is free if no box comes within ``margin`` of it. Boxes no higher than a stair
        do not count.
        """
        taken = self._no_cells()
        radius = self.kind.radius + margin
        for box in boxes:
            dx = np.maximum(np.maximum(box.low[0] - self.xs, self.xs - box.high[0]), 0.0)
            dy = np.maximum(np.maximum(box.low[1] - self.ys, self.ys - box.high[1]), 0.0)
            meets = dx[None, :] ** 2 + dy[:, None] ** 2 < radius * radius - _TOUCH
            layers = (box.high[2] > self.heights + self.kind.step_height + _TOUCH) & (
                box.low[2] < self.heights + height + margin - _TOUCH
            )
            taken[layers] |= meets[None]
        return ~taken

    def _buried_cells(self, boxes: list[Box]) -> Cells:
        """Return a mask of the cells whose centres, at the height of the layer, are inside a box.

        Even boxes no higher than a stair count.
        """
        buried = self._no_cells()
        for box in boxes:
            rows, columns = self._over(box)
            layers = (box.high[2] > self.heights + _TOUCH) & (box.low[2] < self.heights + _TOUCH)
            buried[layers] |= (rows[:, None] & columns[None, :])[None]
        return buried

    def _over(self, box: Box) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
        """Return masks of the rows and of the columns whose centres are inside the ground plan of a box."""
        rows = (self.ys >= box.low[1]) & (self.ys <= box.high[1])
        columns = (self.xs >= box.low[0]) & (self.xs <= box.high[0])
        return rows, columns

    def _no_cells(self) -> Cells:
        return np.zeros((len(self.heights), len(self.ys), len(self.xs)), dtype=np.bool_)
