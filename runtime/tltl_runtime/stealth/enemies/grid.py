"""Where enemies can walk, and the way from anywhere to anywhere.

The floor is cut into cells of 0.25 m.  A cell is walkable where its centre lies outside every obstacle grown by the
enemies' radius to each side.  A grown obstacle is at least 0.7 m wide, which no step to a neighbouring cell can
pass over: one that meets it has an end, or for a diagonal a cell beside it, inside.  So a step between walkable
neighbours, a diagonal one only past two walkable cells, is free as a whole, not at its ends alone.

The next step from every cell to every goal is found for 512 goals at once, one bit each, in 10 to 100 ms, when
one of them is first asked for.  At most 64 MB of these answers are kept per level, those asked for last; all pairs of
8,000 cells fit.  Processes that fork after ``Floor.prepare`` share them.
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
from tltl_runtime.stealth.level import Box, Level
from tltlc.io.limits import WORK

CELL: Final = 0.25
RADIUS: Final = 0.35
"""An enemy's, with the space that it keeps to walls."""
HEIGHT: Final = 1.8
STEP: Final = 0.1
"""Boxes that rise no higher above the floor are walked over."""
NARROW: Final = 2.0
"""A passage no wider is a gap."""
GAP_SPACING: Final = 2.0
"""Gaps are told once in this distance."""

Place = tuple[float, float]

_BUDGET: Final = 64 << 20
_TOUCH: Final = 1e-6


@lru_cache(maxsize=16)
def grid_of(level: Level) -> Grid:
    """The grid of a level, made once in a process."""
    return Grid(level)


def is_too_large(bounds: Box) -> bool:
    """Whether a floor has so many cells that finding the ways on it would take minutes, and gigabytes."""
    columns, rows = (int((bounds.high[axis] - bounds.low[axis]) / CELL + 1e-9) for axis in (0, 1))
    return columns * rows > WORK["cells of floor"]


class Grid:
    """The floors of a level, one for each set of barriers that are shut."""

    def __init__(self, level: Level) -> None:
        self.level = level
        self._floors: dict[frozenset[int], Floor] = {}
        self._answers: OrderedDict[tuple[frozenset[int], int], NDArray[np.uint8]] = OrderedDict()

    def floor(self, shut: Collection[int]) -> Floor:
        """The floor while the barriers with these indices are shut, lasers included: no enemy walks into one."""
        key = frozenset(shut)
        if key not in self._floors:
            boxes = [solid.box for solid in self.level.solids]
            boxes += [self.level.barriers[index].box for index in sorted(key)]
            starts = [enemy.route[0][:2] for enemy in self.level.enemies]
            self._floors[key] = Floor(self.level.bounds, boxes, starts, self, key)
        return self._floors[key]

    def answers(self, floor: Floor, chunk: int) -> NDArray[np.uint8]:
        """The steps towards goals ``chunk * 512`` and following, uint8 [512, cells]."""
        key = (floor.key, chunk)
        if key in self._answers:
            self._answers.move_to_end(key)
            return self._answers[key]
        found = self._answers[key] = steps_to(floor.neighbours, chunk * GOALS)
        while sum(each.nbytes for each in self._answers.values()) > _BUDGET and len(self._answers) > 1:
            self._answers.popitem(last=False)
        return found


class Floor:
    """The walkable cells that an enemy reaches from where one starts, numbered row by row from the south-west."""

    def __init__(
        self, bounds: Box, boxes: Sequence[Box], starts: Sequence[Place], grid: Grid, key: frozenset[int]
    ) -> None:
        self.key = key
        self.obstacles = tuple(_grown(box) for box in boxes if box.low[2] < HEIGHT and box.high[2] > STEP)
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
            nearest_numbers(np.where(areas == each, self._number, -1)) for each in range(int(areas.max()) + 1)
        ]
        self._numbers: Any = self._number.tolist()
        self.neighbours = neighbours(self._number)
        self._next: Any = self.neighbours.tolist()
        self._roomy = self._roomy_cells(rows, columns)
        self._last: tuple[int, bytes] = (-1, b"")
        self._gaps: dict[int, tuple[Place, ...]] = {}

    def is_free(self, x: float, y: float) -> bool:
        """Whether an enemy can stand at x, y: inside the bounds, and clear of all obstacles by its radius."""
        (x0, y0, _), (x1, y1, _) = self._bounds.low, self._bounds.high
        if not (x0 + RADIUS <= x <= x1 - RADIUS and y0 + RADIUS <= y <= y1 - RADIUS):
            return False
        column, row = self._cell(x, y)
        if self._roomy[self._numbers[row][column]]:
            return True
        return not any(a < x < c and b < y < d for a, b, c, d in self.obstacles)

    def clear(self, a: Place, b: Place) -> bool:
        """Whether an enemy can walk straight from a to b, where a and b are inside the bounds."""
        return not crosses(*a, *b, self.obstacles)

    def towards(self, a: Place, b: Place) -> Place | None:
        """Where to walk straight from a, a free place, to get to b or to the place nearest to b.

        It is b itself where nothing is between, and the answer is a where no way leads nearer.  None where no cell's
        centre is in a straight walk from a.
        """
        entry = self.entry(a)
        if entry is None:
            return None
        if self.is_free(*b) and self.clear(a, b):
            return b
        return self._furthest(a, self._way(entry, self.nearest(b, self._area[entry])))

    def way(self, a: Place, b: Place) -> list[Place]:
        """The centres of the cells on a way from a to b; none where there is none."""
        entry = self.entry(a)
        goal = self.entry(b)
        if entry is None or goal is None or self._area[entry] != self._area[goal]:
            return []
        return [self.centres[cell] for cell in self._way(entry, goal)]

    def entry(self, place: Place) -> int | None:
        """The nearest cell whose centre is a straight walk from a place, at most two columns and rows off."""
        x, y = place
        column, row = self._cell(x, y)
        own: int = self._numbers[row][column]
        if self._roomy[own] or (own >= 0 and self.clear(place, self.centres[own])):
            return own
        near = []
        for line in self._numbers[max(0, row - 2) : row + 3]:
            for cell in line[max(0, column - 2) : column + 3]:
                if cell >= 0:
                    cx, cy = self.centres[cell]
                    near.append((hypot(cx - x, cy - y), cell))
        near.sort()
        return next((cell for _, cell in near if self.clear(place, self.centres[cell])), None)

    def nearest(self, place: Place, area: int = 0) -> int:
        """The cell of an area (cells joined by steps) that is about the nearest to a place."""
        column, row = self._cell(*place)
        return int(self._nearest[area][row, column])

    def stand(self, place: Place) -> Place:
        """The place itself where an enemy can stand there and leave, else the nearest cell's centre.

        Raises ValueError where there is no cell.
        """
        if self.is_free(*place) and self.entry(place) is not None:
            return place
        if not self.centres:
            raise ValueError("an enemy has no room anywhere in this level")
        return min(self.centres, key=lambda centre: hypot(centre[0] - place[0], centre[1] - place[1]))

    def prepare(self) -> None:
        """Find the steps between all pairs of cells now, as far as the budget holds them."""
        for chunk in range(-(-len(self.centres) // GOALS)):
            self._grid.answers(self, chunk)

    def gaps(self, area: int = 0) -> tuple[Place, ...]:
        """Narrow places of an area: middles of passages at most 2 m wide, at least 2 m from each other."""
        if area not in self._gaps:
            self._gaps[area] = self._find_gaps(area)
        return self._gaps[area]

    def _find_gaps(self, area: int) -> tuple[Place, ...]:
        mine = np.zeros((self._rows, self._columns), dtype=bool)
        for cell, (x, y) in enumerate(self.centres):
            column, row = self._cell(x, y)
            mine[row, column] = self._area[cell] == area
        most = int((NARROW - 2 * RADIUS) / CELL + 1e-9)
        middle = middles(mine, most) | middles(mine.T, most).T
        found: list[Place] = []
        for row, column in np.argwhere(middle & mine):
            x, y = self._centre(int(column), int(row))
            if all(hypot(x - a, y - b) >= GAP_SPACING for a, b in found):
                found.append((x, y))
        return tuple(found)

    def area(self, place: Place) -> int:
        """The area in which a place is; the first where it is in none."""
        entry = self.entry(place)
        return 0 if entry is None else self._area[entry]

    def _way(self, entry: int, goal: int) -> list[int]:
        """Cells from entry to goal, both included; the entry alone where there is no way."""
        if self._last[0] != goal:
            steps = self._grid.answers(self, goal // GOALS)
            self._last = (goal, steps[goal % GOALS].tobytes())
        field = self._last[1]
        way = [entry]
        cell = entry
        while (move := field[cell]) < ARRIVED:
            cell = self._next[move][cell]
            way.append(cell)
        return way

    def _furthest(self, a: Place, way: Sequence[int]) -> Place:
        """A cell's centre far along the way that is a straight walk from a; doubling finds one in few tests."""
        reach, stride = 0, 1
        while stride and reach < len(way) - 1:
            ahead = min(reach + stride, len(way) - 1)
            if self.clear(a, self.centres[way[ahead]]):
                reach, stride = ahead, stride * 2
            else:
                stride = min(stride, ahead - reach) // 2
        if reach == 0 and a == self.centres[way[0]] and len(way) > 1:
            reach = 1
        return self.centres[way[reach]]

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
        """For each cell the number of the area to which it belongs, -1 where no enemy comes."""
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
        """For each cell whether it is free as a whole, and at last that -1, which is no cell, is not.

        The last row and column are not: places beyond them, up to the bounds, count as theirs.
        """
        x, y = self._bounds.low[0] + columns * CELL, self._bounds.low[1] + rows * CELL
        roomy = (columns < self._columns - 1) & (rows < self._rows - 1)
        for a, b, c, d in self.obstacles:
            roomy &= (x >= c) | (x + CELL <= a) | (y >= d) | (y + CELL <= b)
        return [*map(bool, roomy), False]


def _grown(box: Box) -> Rectangle:
    grow = RADIUS - _TOUCH
    return (box.low[0] - grow, box.low[1] - grow, box.high[0] + grow, box.high[1] + grow)
