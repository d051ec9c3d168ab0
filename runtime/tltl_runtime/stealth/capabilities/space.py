"""The free space of a level for the feet of a player, cut into boxes, with nothing that is free left out.

The level is cut into square cells, and in height at every value where anything begins or ends to be in the way, so
that heights are exact.  A box of space is free if the body fits with its feet anywhere in it; for that the body is the
crouched one, 5 cm narrower than it is, and round at both ends.
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
"""Metres to a side of a cell; twice that, and so on, in levels so large that there would be too many."""

_MOST_BOXES: Final = 30_000_000
"""Of space, in all slabs."""

_WIDTHS: Final = (0.25, 0.15)
"""How far a box may be from the middle of the body to be in its way, in metres; the radius of the body is 0.3.

The body is 5 cm narrower than it is: no contact in the physics is deeper.  Its round ends come down less far beside
its middle, so what is nearer is in the way at more heights; two widths of that do.
"""

_ROUNDING: Final = 1e-5

Field = NDArray[np.bool_]
"""[rows, columns] of cells, rows along y."""

Space = NDArray[np.bool_]
"""[slabs, rows, columns]"""


class SpaceBudgetError(Exception):
    """A search has looked at more cells of space than it may."""


class Budget:
    """Counts the cells of space that a search looks at; raises SpaceBudgetError beyond ``most``."""

    def __init__(self, most: int) -> None:
        self._left = most

    def spend(self, cells: int) -> None:
        """Count cells."""
        self._left -= cells
        if self._left < 0:
            raise SpaceBudgetError


class SpaceGrid:
    """The cells and slabs of a level; ``cuts`` are heights at which slabs must end, beside those of the boxes.

    ``origin`` is the south-west corner, ``cell`` the side of a cell in metres; ``west`` [columns] and ``south`` [rows]
    are where they begin, ``lows`` and ``highs`` [slabs] the ends of the slabs, in metres, upwards.  ``shape`` is that
    of a space: slabs, rows, columns.  What looks at cells counts them in ``budget``.
    """

    def __init__(
        self, bounds: Box, boxes: Iterable[Box], cuts: Iterable[float], kind: PlayerKind, budget: Budget
    ) -> None:
        self.budget = budget
        (x0, y0, z0), (x1, y1, z1) = bounds.low, bounds.high
        self.origin = (x0, y0)
        self._widths = [(width, kind.radius - sqrt(kind.radius**2 - width**2)) for width in _WIDTHS]
        """Each with how much shorter the body is there, at either end."""
        self._height = kind.crouched_height
        ends = {z for box in boxes for _, shorter in self._widths for z in self._in_the_way(box, shorter)}
        inside = sorted({round(z, 6) for z in (*ends, *cuts) if z0 < z < z1})
        self.lows, self.highs = np.array([z0, *inside]), np.array([*inside, z1])
        self.cell = CELL
        while len(self.lows) * (x1 - x0) * (y1 - y0) > _MOST_BOXES * self.cell**2:
            self.cell *= 2
        self.west = x0 + self.cell * np.arange(int(np.ceil((x1 - x0) / self.cell - 1e-6)))
        self.south = y0 + self.cell * np.arange(int(np.ceil((y1 - y0) / self.cell - 1e-6)))
        self.shape = (len(self.lows), len(self.south), len(self.west))

    def free(self, boxes: Iterable[Box]) -> Space:
        """The space that is left beside boxes."""
        self.budget.spend(prod(self.shape))
        free: Space = np.ones(self.shape, dtype=np.bool_)
        for box in boxes:
            self.budget.spend(sum(self.shape))
            # The point of a cell that is farthest away decides: only where all of a cell is taken, none of it is free.
            dx = np.maximum(np.maximum(box.low[0] - self.west, self.west + self.cell - box.high[0]), 0.0)
            dy = np.maximum(np.maximum(box.low[1] - self.south, self.south + self.cell - box.high[1]), 0.0)
            rows, columns = span(dy < max(_WIDTHS)), span(dx < max(_WIDTHS))
            apart = dx[None, columns] ** 2 + dy[rows, None] ** 2
            for width, shorter in self._widths:
                low, high = self._in_the_way(box, shorter)
                slabs = span((self.lows >= low - _ROUNDING) & (self.highs <= high + _ROUNDING))
                self.budget.spend((slabs.stop - slabs.start) * apart.size)
                free[slabs, rows, columns] &= apart >= width * width
        return free

    def over(self, box: Box, reach: float) -> Field:
        """The cells of which any point is within ``reach`` of a box, seen from above."""
        self.budget.spend(self.shape[1] * self.shape[2])
        dx = np.maximum(np.maximum(box.low[0] - self.west - self.cell, self.west - box.high[0]), 0.0)
        dy = np.maximum(np.maximum(box.low[1] - self.south - self.cell, self.south - box.high[1]), 0.0)
        found: Field = dx[None, :] ** 2 + dy[:, None] ** 2 <= reach * reach
        return found

    def slabs(self, low: float, high: float) -> NDArray[np.bool_]:
        """The slabs that share heights with an interval."""
        found: NDArray[np.bool_] = (self.lows < high - _ROUNDING) & (self.highs > low + _ROUNDING)
        return found

    def distance(self, space: Space, point: Point, most: float = inf) -> float:
        """The least distance from anywhere in a space to a point, infinite where it is more than ``most``."""
        away = [_away(lows, highs, value) for (lows, highs), value in zip(self._ends(), point[::-1], strict=True)]
        radius = min(self.cell, most)
        while True:
            # What is nearer than the radius lies in a part around the point; most searches end in a small one.
            part = tuple(span(each <= radius) for each in away)
            slabs, rows, columns = (each[within] ** 2 for each, within in zip(away, part, strict=True))
            self.budget.spend(slabs.size * rows.size * columns.size)
            apart = slabs[:, None, None] + rows[:, None] + columns
            nearest = float(np.sqrt(np.min(apart, where=space[part], initial=inf)))
            if nearest <= radius:
                return nearest
            if radius >= min(most, max(float(each.max()) for each in away)):
                return nearest if nearest <= most else inf
            radius = min(4 * radius, most)

    def _ends(self) -> list[tuple[NDArray[np.float64], NDArray[np.float64]]]:
        """Where slabs, rows and columns begin and end."""
        rows, columns = (self.south, self.south + self.cell), (self.west, self.west + self.cell)
        return [(self.lows, self.highs), rows, columns]

    def _in_the_way(self, box: Box, shorter: float) -> tuple[float, float]:
        """The heights of feet at which a box that is near enough is in the way of a body that ends sooner."""
        return box.low[2] - self._height + shorter, box.high[2] - shorter


def _away(lows: NDArray[np.float64], highs: NDArray[np.float64], value: float) -> NDArray[np.float64]:
    """How far a value is from intervals."""
    away: NDArray[np.float64] = np.maximum(np.maximum(lows - value, value - highs), 0.0)
    return away


def flood(free: Space, seeds: Space, budget: Budget) -> Space:
    """What of a space is connected with the seeds in it, side by side.

    Each round spreads along whole lines of one axis after the other, so that a few rounds go round many corners.
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
    """A number for each box, the same for neighbours on a line between which nothing is taken."""
    starts = ~free
    starts[..., 0] = True
    ids = np.cumsum(starts.reshape(-1), dtype=np.int32).reshape(free.shape) - 1
    return ids, int(ids.flat[-1]) + 1


def distances(field: Field, most: int) -> NDArray[np.float64]:
    """From each cell, the distance in cells to the nearest one of a field, between their nearest points.

    It is infinite where it is ``most`` or more.
    """
    rows, columns = field.shape
    places = np.arange(columns, dtype=np.float64)
    left = np.maximum.accumulate(np.where(field, places, -np.inf), axis=1)
    right = np.minimum.accumulate(np.where(field, places, np.inf)[:, ::-1], axis=1)[:, ::-1]
    across = np.maximum(np.minimum(places - left, right - places) - 1.0, 0.0) ** 2
    squares = across.copy()
    for offset in range(1, min(most + 1, rows)):
        apart = float((offset - 1) ** 2)
        np.minimum(squares[offset:], across[:-offset] + apart, out=squares[offset:])
        np.minimum(squares[:-offset], across[offset:] + apart, out=squares[:-offset])
    found: NDArray[np.float64] = np.where(squares < most * most, np.sqrt(squares), np.inf)
    return found


def span(which: NDArray[np.bool_]) -> slice:
    """From the first true element to the last."""
    indices = np.flatnonzero(which)
    return slice(int(indices[0]), int(indices[-1]) + 1) if len(indices) else slice(0, 0)
