"""The space of a level where the player's feet can be, cut into boxes.

The ground plan is cut into square cells, and the height into slabs. A slab ends at every height
where an obstacle begins or ceases to be in the way, so heights are exact. A box of space is one
cell in one slab. It counts as free if there may be room for the body somewhere in the box, so no
free space is missed. The body is that of a crouched player, 5 cm narrower than in the game, with
two round ends.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import inf, prod, sqrt
from typing import Final

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.stealth.level import Box, Point
from tltl_runtime.stealth.world.player import PlayerKind

CELL: Final = 0.25
"""The side of a cell, in metres.

:class:`SpaceGrid` doubles it until the level has at most ``_MOST_BOXES`` boxes of space.
"""

_MOST_BOXES: Final = 30_000_000
"""The most boxes of space, over all slabs."""

_WIDTHS: Final = (0.25, 0.15)
"""Distances from the body's axis within which an obstacle is in the way, in metres.

The body is 5 cm narrower here, because no contact in the physics is deeper. Its ends are round, so
it is shorter farther from its axis: an obstacle near the axis is in the way at more heights. Two
distances approximate this well enough.
"""

_ROUNDING: Final = 1e-5

CellMask = NDArray[np.bool_]
"""A mask of cells, [rows, columns]; rows go north."""

Space = NDArray[np.bool_]
"""A mask of boxes of space, [slabs, rows, columns]."""


class SpaceBudgetError(Exception):
    """Raised if a search examines more cells of space than its budget allows."""


class Budget:
    """Counts the cells of space that a search examines, up to a limit.

    :meth:`spend` raises SpaceBudgetError as soon as the count exceeds ``most``.
    """

    def __init__(self, most: int) -> None:
        self._remaining = most

    def spend(self, cells: int) -> None:
        """Count ``cells`` more cells as examined."""
        self._remaining -= cells
        if self._remaining < 0:
            raise SpaceBudgetError


class SpaceGrid:
    """Cuts a level into square cells of its ground plan and into slabs of height.

    Slabs end where ``boxes`` begin or cease to block the body of a player of ``kind``, and at the
    heights ``cuts``. ``origin`` is the south-west corner of the level, ``cell`` the side of a cell.
    ``west`` [columns] and ``south`` [rows] are the west and south edges of the cells, ``lows`` and
    ``highs`` [slabs] the ends of the slabs, upwards. All are in metres. ``shape`` is the shape of a
    mask of the whole space: slabs, rows, columns. ``budget`` counts the cells that each method
    examines.
    """

    def __init__(
        self, bounds: Box, boxes: Iterable[Box], cuts: Iterable[float], kind: PlayerKind, budget: Budget
    ) -> None:
        self.budget = budget
        (x0, y0, z0), (x1, y1, z1) = bounds.low, bounds.high
        self.origin = (x0, y0)
        self._widths = [(width, kind.radius - sqrt(kind.radius**2 - width**2)) for width in _WIDTHS]
        """For each of ``_WIDTHS``, how much shorter each end of the body is there, in metres."""
        self._height = kind.crouched_height
        ends = {z for box in boxes for _, shorter in self._widths for z in self._blocked_heights(box, shorter)}
        inside = sorted({round(z, 6) for z in (*ends, *cuts) if z0 < z < z1})
        self.lows, self.highs = np.array([z0, *inside]), np.array([*inside, z1])
        self.cell = CELL
        while len(self.lows) * (x1 - x0) * (y1 - y0) > _MOST_BOXES * self.cell**2:
            self.cell *= 2
        self.west = x0 + self.cell * np.arange(int(np.ceil((x1 - x0) / self.cell - 1e-6)))
        self.south = y0 + self.cell * np.arange(int(np.ceil((y1 - y0) / self.cell - 1e-6)))
        self.shape = (len(self.lows), len(self.south), len(self.west))

    def free_space(self, boxes: Iterable[Box]) -> Space:
        """Return a mask of the space where the player's feet can be if ``boxes`` stop the body."""
        self.budget.spend(prod(self.shape))
        free: Space = np.ones(self.shape, dtype=np.bool_)
        for box in boxes:
            self.budget.spend(sum(self.shape))
            # Use the farthest point of each cell: a cell counts as taken only if all of it is taken.
            dx = np.maximum(np.maximum(box.low[0] - self.west, self.west + self.cell - box.high[0]), 0.0)
            dy = np.maximum(np.maximum(box.low[1] - self.south, self.south + self.cell - box.high[1]), 0.0)
            rows, columns = span(dy < max(_WIDTHS)), span(dx < max(_WIDTHS))
            apart = dx[None, columns] ** 2 + dy[rows, None] ** 2
            for width, shorter in self._widths:
                low, high = self._blocked_heights(box, shorter)
                slabs = span((self.lows >= low - _ROUNDING) & (self.highs <= high + _ROUNDING))
                self.budget.spend((slabs.stop - slabs.start) * apart.size)
                free[slabs, rows, columns] &= apart >= width * width
        return free

    def cells_near(self, box: Box, reach: float) -> CellMask:
        """Return a mask of the cells that have a point within ``reach`` metres of a box.

        Only horizontal distances count.
        """
        self.budget.spend(self.shape[1] * self.shape[2])
        dx = np.maximum(np.maximum(box.low[0] - self.west - self.cell, self.west - box.high[0]), 0.0)
        dy = np.maximum(np.maximum(box.low[1] - self.south - self.cell, self.south - box.high[1]), 0.0)
        cells: CellMask = dx[None, :] ** 2 + dy[:, None] ** 2 <= reach * reach
        return cells

    def slabs(self, low: float, high: float) -> NDArray[np.bool_]:
        """Return a mask of the slabs that overlap the heights from ``low`` to ``high``."""
        overlapping: NDArray[np.bool_] = (self.lows < high - _ROUNDING) & (self.highs > low + _ROUNDING)
        return overlapping

    def distance(self, space: Space, point: Point, most: float = inf) -> float:
        """Return the least distance from the space in the mask ``space`` to a point, in metres.

        Return infinity if the distance is more than ``most``.
        """
        offsets_by_axis = [
            _interval_distances(lows, highs, value)
            for (lows, highs), value in zip(self._ends(), point[::-1], strict=True)
        ]
        radius = min(self.cell, most)
        while True:
            # Search only the part of the space within the radius first; most searches end in a small part.
            part = tuple(span(offsets <= radius) for offsets in offsets_by_axis)
            slabs, rows, columns = (offsets[within] ** 2 for offsets, within in zip(offsets_by_axis, part, strict=True))
            self.budget.spend(slabs.size * rows.size * columns.size)
            apart = slabs[:, None, None] + rows[:, None] + columns
            nearest = float(np.sqrt(np.min(apart, where=space[part], initial=inf)))
            if nearest <= radius:
                return nearest
            if radius >= min(most, max(float(offsets.max()) for offsets in offsets_by_axis)):
                return nearest if nearest <= most else inf
            radius = min(4 * radius, most)

    def _ends(self) -> list[tuple[NDArray[np.float64], NDArray[np.float64]]]:
        """Return the low and high ends of all slabs, of all rows and of all columns, in metres."""
        rows, columns = (self.south, self.south + self.cell), (self.west, self.west + self.cell)
        return [(self.lows, self.highs), rows, columns]

    def _blocked_heights(self, box: Box, shorter: float) -> tuple[float, float]:
        """Return the least and the greatest height of the feet at which ``box`` blocks the body.

        The body has round ends, so it is shorter at some distance from its axis than at the axis.
        At the distance of the box, each end is ``shorter`` metres shorter.
        """
        return box.low[2] - self._height + shorter, box.high[2] - shorter


def _interval_distances(lows: NDArray[np.float64], highs: NDArray[np.float64], value: float) -> NDArray[np.float64]:
    """Return the distance of ``value`` from each interval; 0 inside the interval."""
    offsets_by_axis: NDArray[np.float64] = np.maximum(np.maximum(lows - value, value - highs), 0.0)
    return offsets_by_axis


def flood(free: Space, seeds: Space, budget: Budget) -> Space:
    """Return the free boxes of space that can be reached from ``seeds`` through common faces of boxes.

    ``free``, ``seeds`` and the result are masks. Each round of the search spreads along whole lines
    of each axis in turn, so even a way around many corners takes few rounds.
    """
    budget.spend(3 * free.size)
    reached: Space = seeds & free
    runs = [_runs(np.moveaxis(free, axis, -1)) for axis in range(3)]
    count = -1
    while count != (count := int(np.count_nonzero(reached))):
        budget.spend(3 * free.size)
        for axis, (ids, number) in enumerate(runs):
            turned = np.moveaxis(reached, axis, -1)
            hit = np.zeros(number, dtype=np.bool_)
            hit[ids[turned]] = True
            reached = np.moveaxis(hit[ids] & np.moveaxis(free, axis, -1), -1, axis)
    return reached


def _runs(free: Space) -> tuple[NDArray[np.int32], int]:
    """Number the runs along the last axis of ``free``; a run is a sequence of free boxes without a gap.

    Return an array of the shape of ``free`` with the number of the run of each free box, and the
    count of numbers. Boxes that are not free have meaningless numbers.
    """
    starts = ~free
    starts[..., 0] = True
    ids = np.cumsum(starts.reshape(-1), dtype=np.int32).reshape(free.shape) - 1
    return ids, int(ids.flat[-1]) + 1


def distances(mask: CellMask, most: int) -> NDArray[np.float64]:
    """Return the distance, in cells, from each cell to the nearest true cell of ``mask``.

    A distance is measured between the nearest points of the two cells. It is infinite where it
    would be ``most`` or more.
    """
    rows, columns = mask.shape
    places = np.arange(columns, dtype=np.float64)
    left = np.maximum.accumulate(np.where(mask, places, -np.inf), axis=1)
    right = np.minimum.accumulate(np.where(mask, places, np.inf)[:, ::-1], axis=1)[:, ::-1]
    across = np.maximum(np.minimum(places - left, right - places) - 1.0, 0.0) ** 2
    squares = across.copy()
    for offset in range(1, min(most + 1, rows)):
        apart = float((offset - 1) ** 2)
        np.minimum(squares[offset:], across[:-offset] + apart, out=squares[offset:])
        np.minimum(squares[:-offset], across[offset:] + apart, out=squares[:-offset])
    distances: NDArray[np.float64] = np.where(squares < most * most, np.sqrt(squares), np.inf)
    return distances


def span(mask: NDArray[np.bool_]) -> slice:
    """Return the slice from the first true element to the last; an empty slice if none is true."""
    indices = np.flatnonzero(mask)
    return slice(int(indices[0]), int(indices[-1]) + 1) if len(indices) else slice(0, 0)
