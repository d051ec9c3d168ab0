"""The floor that enemies can walk on, and shortest paths between all its cells.

The floor is cut into cells of 0.25 m. A cell is walkable if its centre lies outside every obstacle
grown by the enemies' radius on each side. A grown obstacle is at least 0.7 m wide, so no step to a
neighbouring cell can jump over it. A straight step that crosses an obstacle begins or ends in a
cell that is not walkable. So does a diagonal step, or it passes between two cells of which one is
not walkable. Therefore a step between walkable neighbours is free along its whole length, provided
that a diagonal step passes between two walkable cells.

:class:`Grid` computes the next steps from all cells to a goal when the goal is first needed, for
512 goals at once, with one bit per goal. This takes 10 to 100 ms. A cache of at most 64 MB per
level keeps the results that were used last; all pairs of 8,000 cells fit. Processes that fork after
``Floor.prepare`` share the cache.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Collection, Sequence
from functools import lru_cache
from math import hypot
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.stealth.enemies.fields import ARRIVED, GOALS, middles, nearest_numbers, neighbours, steps_to
from tltl_runtime.stealth.enemies.segments import Rectangle, crosses
from tltl_runtime.stealth.level import Box, StealthLevel
from tltlc.api import fileio

CELL: Final = 0.25
RADIUS: Final = 0.35
"""The radius of an enemy, including the distance that it keeps from walls, in metres."""
HEIGHT: Final = 1.8
STEP: Final = 0.1
"""Boxes whose tops are at most at this height, in metres, do not stop enemies."""
NARROW: Final = 2.0
"""A passage that is at most this wide, in metres, is a gap."""
GAP_SPACING: Final = 2.0
"""The least distance between the middles of two gaps, in metres."""

Place = tuple[float, float]

_BUDGET: Final = 64 << 20
_TOUCH: Final = 1e-6


@lru_cache(maxsize=16)
def grid_of(level: StealthLevel) -> Grid:
    """Return the grid of a level: its floors, and paths on them. It is cached per process."""
    return Grid(level)


def is_too_large(bounds: Box) -> bool:
    """Whether ``bounds`` are so large that the shortest paths would take minutes and gigabytes."""
    columns, rows = (int((bounds.high[axis] - bounds.low[axis]) / CELL + 1e-9) for axis in (0, 1))
    return columns * rows > fileio.limits.WORK["cells of floor"]


class Grid:
    """The floors of a level, one for each set of shut barriers, and shortest paths on them."""

    def __init__(self, level: StealthLevel) -> None:
        self.level = level
        self._floors: dict[frozenset[int], Floor] = {}
        self._steps_to_goals: OrderedDict[tuple[frozenset[int], int], NDArray[np.uint8]] = OrderedDict()

    def floor(self, shut: Collection[int]) -> Floor:
        """Return the floor while the barriers with the indices ``shut`` are shut.

        Lasers count as barriers here: no enemy walks into a laser.
        """
        key = frozenset(shut)
        if key not in self._floors:
            boxes = [solid.box for solid in self.level.solids]
            boxes += [self.level.barriers[index].box for index in sorted(key)]
            starts = [enemy.route[0][:2] for enemy in self.level.enemies]
            self._floors[key] = Floor(self.level.bounds, boxes, starts, self, key)
        return self._floors[key]

    def steps_to_goals(self, floor: Floor, chunk: int) -> NDArray[np.uint8]:
        """Return the first steps of shortest paths from all cells of a floor to up to 512 goals.

        The goals are the cells from number ``chunk * 512`` on. The result is that of
        :func:`steps_to`, uint8 [512 or fewer, cells].
        """
        key = (floor.key, chunk)
        if key in self._steps_to_goals:
            self._steps_to_goals.move_to_end(key)
            return self._steps_to_goals[key]
        steps = self._steps_to_goals[key] = steps_to(floor.neighbours, chunk * GOALS)
        while (
            sum(answer.nbytes for answer in self._steps_to_goals.values()) > _BUDGET and len(self._steps_to_goals) > 1
        ):
            self._steps_to_goals.popitem(last=False)
        return steps


class Floor:
    """The walkable cells that enemies can reach from their ``starts``.

    The cells are numbered row by row from the south-west. ``key`` has the indices of the shut
    barriers.
    """

    def __init__(
        self, bounds: Box, boxes: Sequence[Box], starts: Sequence[Place], grid: Grid, key: frozenset[int]
    ) -> None:
        self.key = key
        self.obstacles = tuple(_grow(box) for box in boxes if box.low[2] < HEIGHT and box.high[2] > STEP)
        self._grid = grid
        self._bounds = bounds
        self._columns = max(1, int((bounds.high[0] - bounds.low[0]) / CELL + 1e-9))
        self._rows = max(1, int((bounds.high[1] - bounds.low[1]) / CELL + 1e-9))
        free = self._free_cells()
        areas = self._areas(free, starts)
        self._number = np.full(free.shape, -1, dtype=np.int64)
        self._number[areas >= 0] = np.arange(np.count_nonzero(areas >= 0))
        rows, columns = np.nonzero(areas >= 0)
        self.centres: list[Place] = [self._centre(int(c), int(r)) for r, c in zip(rows, columns, strict=True)]
        self._area: list[int] = areas[rows, columns].tolist()
        self._nearest = [
            nearest_numbers(np.where(areas == area, self._number, -1)) for area in range(int(areas.max()) + 1)
        ]
        self._numbers: Any = self._number.tolist()
        self.neighbours = neighbours(self._number)
        self._next: Any = self.neighbours.tolist()
        self._roomy = self._roomy_cells(rows, columns)
        self._last: tuple[int, bytes] = (-1, b"")
        self._gaps: dict[int, tuple[Place, ...]] = {}

    def is_free(self, x: float, y: float) -> bool:
        """Whether an enemy can stand at x, y.

        Its body must be inside the bounds and clear of all obstacles.
        """
        (x0, y0, _), (x1, y1, _) = self._bounds.low, self._bounds.high
        if not (x0 + RADIUS <= x <= x1 - RADIUS and y0 + RADIUS <= y <= y1 - RADIUS):
            return False
        column, row = self._cell(x, y)
        if self._roomy[self._numbers[row][column]]:
            return True
        return not any(a < x < c and b < y < d for a, b, c, d in self.obstacles)

    def is_clear(self, a: Place, b: Place) -> bool:
        """Whether an enemy can walk straight from ``a`` to ``b``, both inside the bounds."""
        return not crosses(*a, *b, self.obstacles)

    def next_point(self, a: Place, b: Place) -> Place | None:
        """Return the first stop on an enemy's path from ``a`` to ``b``.

        The enemy can walk to this stop in a straight line. An enemy must be able to stand at ``a``.
        If ``b`` cannot be reached, the path leads to the reachable place nearest to ``b``.

        - The result is ``b`` if the straight line to ``b`` is free.
        - It is ``a`` if no path leads nearer to ``b``.
        - It is None if no cell's centre can be reached from ``a`` in a straight line.
        """
        entry = self.entry(a)
        if entry is None:
            return None
        if self.is_free(*b) and self.is_clear(a, b):
            return b
        return self._furthest_straight(a, self._cell_path(entry, self.nearest(b, self._area[entry])))

    def path(self, a: Place, b: Place) -> list[Place]:
        """Return the centres of the cells on a shortest path from ``a`` to ``b``.

        Return an empty list if there is no path.
        """
        entry = self.entry(a)
        goal = self.entry(b)
        if entry is None or goal is None or self._area[entry] != self._area[goal]:
            return []
        return [self.centres[cell] for cell in self._cell_path(entry, goal)]

    def entry(self, place: Place) -> int | None:
        """Return the number of the nearest cell whose centre an enemy at a place can reach in a straight line.

        The cell is at most two columns and two rows away. Return None if there is no such cell.
        """
        x, y = place
        column, row = self._cell(x, y)
        own: int = self._numbers[row][column]
        if self._roomy[own] or (own >= 0 and self.is_clear(place, self.centres[own])):
            return own
        near = []
        for line in self._numbers[max(0, row - 2) : row + 3]:
            for cell in line[max(0, column - 2) : column + 3]:
                if cell >= 0:
                    cx, cy = self.centres[cell]
                    near.append((hypot(cx - x, cy - y), cell))
        near.sort()
        return next((cell for _, cell in near if self.is_clear(place, self.centres[cell])), None)

    def nearest(self, place: Place, area: int = 0) -> int:
        """Return the number of the cell in an area that is nearest to a place, approximately.

        An area is a set of cells that are connected by steps. ``area`` is its number.
        """
        column, row = self._cell(*place)
        return int(self._nearest[area][row, column])

    def standing_place(self, place: Place) -> Place:
        """Return ``place`` if an enemy can stand and move there, else the nearest cell's centre.

        Raises ValueError if the floor has no cell.
        """
        if self.is_free(*place) and self.entry(place) is not None:
            return place
        if not self.centres:
            raise ValueError("an enemy has no room anywhere in this level")
        return min(self.centres, key=lambda centre: hypot(centre[0] - place[0], centre[1] - place[1]))

    def prepare(self) -> None:
        """Compute the shortest paths between all pairs of cells now, and keep as many as the cache can hold."""
        for chunk in range(-(-len(self.centres) // GOALS)):
            self._grid.steps_to_goals(self, chunk)

    def gaps(self, area: int = 0) -> tuple[Place, ...]:
        """Return the middles of the gaps in an area; a gap is a passage at most 2 m wide.

        An area is a set of connected cells. The middles are at least 2 m apart.
        """
        if area not in self._gaps:
            self._gaps[area] = self._find_gaps(area)
        return self._gaps[area]

    def _find_gaps(self, area: int) -> tuple[Place, ...]:
        in_area = np.zeros((self._rows, self._columns), dtype=bool)
        for cell, (x, y) in enumerate(self.centres):
            column, row = self._cell(x, y)
            in_area[row, column] = self._area[cell] == area
        most = int((NARROW - 2 * RADIUS) / CELL + 1e-9)
        middle = middles(in_area, most) | middles(in_area.T, most).T
        gaps: list[Place] = []
        for row, column in np.argwhere(middle & in_area):
            x, y = self._centre(int(column), int(row))
            if all(hypot(x - a, y - b) >= GAP_SPACING for a, b in gaps):
                gaps.append((x, y))
        return tuple(gaps)

    def area(self, place: Place) -> int:
        """Return the number of the area at a place; 0 if there is none.

        An area is a set of cells that are connected by steps.
        """
        entry = self.entry(place)
        return 0 if entry is None else self._area[entry]

    def _cell_path(self, entry: int, goal: int) -> list[int]:
        """Return the numbers of the cells on a shortest path from ``entry`` to ``goal``, both included.

        Return only ``entry`` if there is no path.
        """
        if self._last[0] != goal:
            steps = self._grid.steps_to_goals(self, goal // GOALS)
            self._last = (goal, steps[goal % GOALS].tobytes())
        field = self._last[1]
        path = [entry]
        cell = entry
        while (move := field[cell]) < ARRIVED:
            cell = self._next[move][cell]
            path.append(cell)
        return path

    def _furthest_straight(self, a: Place, path: Sequence[int]) -> Place:
        """Return the centre of a cell far along ``path`` that can be reached straight from ``a``.

        The search doubles its stride, so it makes few tests and may miss cells even farther along.
        """
        reach, stride = 0, 1
        while stride and reach < len(path) - 1:
            ahead = min(reach + stride, len(path) - 1)
            if self.is_clear(a, self.centres[path[ahead]]):
                reach, stride = ahead, stride * 2
            else:
                stride = min(stride, ahead - reach) // 2
        if reach == 0 and a == self.centres[path[0]] and len(path) > 1:
            reach = 1
        return self.centres[path[reach]]

    def _cell(self, x: float, y: float) -> tuple[int, int]:
        column = int((x - self._bounds.low[0]) / CELL)
        row = int((y - self._bounds.low[1]) / CELL)
        return min(max(column, 0), self._columns - 1), min(max(row, 0), self._rows - 1)

    def _centre(self, column: int, row: int) -> Place:
        return self._bounds.low[0] + (column + 0.5) * CELL, self._bounds.low[1] + (row + 0.5) * CELL

    def _free_cells(self) -> NDArray[np.bool_]:
        x = self._bounds.low[0] + (np.arange(self._columns) + 0.5) * CELL
        y = self._bounds.low[1] + (np.arange(self._rows) + 0.5) * CELL
        (x0, y0, _), (x1, y1, _) = self._bounds.low, self._bounds.high
        free = np.outer(
            (y >= y0 + RADIUS) & (y <= y1 - RADIUS),
            (x >= x0 + RADIUS) & (x <= x1 - RADIUS),
        )
        for a, b, c, d in self.obstacles:
            free &= ~np.outer((y > b) & (y < d), (x > a) & (x < c))
        return free

    def _areas(self, free: NDArray[np.bool_], starts: Sequence[Place]) -> NDArray[np.int64]:
        """Return the number of the area of each cell, int64 [rows, columns].

        ``free`` is a mask of the walkable cells. An area is a set of connected cells. The number is
        -1 for a cell that cannot be reached from any of ``starts``.
        """
        areas = np.full(free.shape, -1, dtype=np.int64)
        rows, columns = np.nonzero(free)
        if not len(rows):
            return areas
        for start in starts:
            column, row = self._cell(*start)
            best = int(np.argmin((rows - row) ** 2 + (columns - column) ** 2))
            if areas[rows[best], columns[best]] >= 0:
                continue
            reached = np.zeros_like(free)
            reached[rows[best], columns[best]] = True
            count = 0
            while (size := int(np.count_nonzero(reached))) != count:
                count = size
                wider = reached.copy()
                wider[1:] |= reached[:-1]
                wider[:-1] |= reached[1:]
                wider[:, 1:] |= reached[:, :-1]
                wider[:, :-1] |= reached[:, 1:]
                reached = wider & free
            areas[reached] = int(areas.max()) + 1
        return areas

    def _roomy_cells(self, rows: NDArray[Any], columns: NDArray[Any]) -> list[bool]:
        """Return a bool for each cell: whether the whole cell is clear of obstacles.

        The list has a further last element, False, so that the index -1, which stands for "no
        cell", gives False. Cells of the last row and column are also False: a position between such
        a cell and the bounds counts as in the cell.
        """
        x, y = self._bounds.low[0] + columns * CELL, self._bounds.low[1] + rows * CELL
        roomy = (columns < self._columns - 1) & (rows < self._rows - 1)
        for a, b, c, d in self.obstacles:
            roomy &= (x >= c) | (x + CELL <= a) | (y >= d) | (y + CELL <= b)
        return [*map(bool, roomy), False]


def _grow(box: Box) -> Rectangle:
    grow = RADIUS - _TOUCH
    return (box.low[0] - grow, box.low[1] - grow, box.high[0] + grow, box.high[1] + grow)
