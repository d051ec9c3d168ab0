"""The fastest routes to a goal from everywhere in a level.

Routes are paths in a graph. The vertices are the places of
:class:`~tltl_runtime.stealth.expert.surfaces.Surfaces`, where a player can stand. The edges are
what a player can do: walk, crouch, climb, leap and drop. The graph ignores movers (moving boxes)
and enemies. Times are approximate, but routes are safe: an edge exists only if the body passes with
room to spare.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from functools import lru_cache
from heapq import heappop, heappush
from math import dist, hypot, inf, sqrt
from typing import Any, Final, Literal

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.stealth.expert.surfaces import CELL, Cells, Surfaces
from tltl_runtime.stealth.level import Point, StealthLevel
from tltl_runtime.stealth.snapshot import Snapshot
from tltlc.api import record

Seconds = NDArray[np.float64]
_Edges = tuple[NDArray[np.intp], NDArray[np.intp], Seconds, NDArray[np.intp]]

_DIRECTIONS: Final = ((0, 1), (0, -1), (1, 0), (-1, 0), (1, 1), (1, -1), (-1, 1), (-1, -1))
_CLIMB: Final = 1.0
"""The highest edge that a jump reaches, in metres."""
_CLIMB_REACH, _DROP_REACH, _LEAP_REACH = 1.0, 1.0, 3.0
"""The greatest lengths of a climb, a drop and a leap, in metres from centre to centre."""
_JUMP_TIME: Final = 0.3
"""The seconds that a jump takes in addition to a walk over the same distance."""
_GOAL: Final = 0.6
"""A place within this distance of a goal counts as the goal, in metres."""
_MOST_CACHED: Final = 64
"""At most this many route fields are cached for each set of shut barriers."""
_CLOSE_TO_WALL: Final = 1.25
"""A walk past a wall with hardly any room counts as this many times as long."""

Kind = Literal["walk", "crouch", "climb", "drop", "leap"]

_KINDS: Final[tuple[Kind, ...]] = ("walk", "crouch", "climb", "drop", "leap")


@record
class Leg:
    """A piece of a route: ``kind`` says how to get to its end, ``place``."""

    kind: Kind
    place: Point


@record
class RouteField:
    """The routes to a goal from all places where a player can stand.

    ``seconds`` [layers, rows, columns] is the time from each place to the goal, where a layer is a
    height; it is infinite if there is no route. ``towards`` [places] is the flat index of the next
    place on the route, or -1 at the goal and where there is no route. ``kinds`` [places] is how to
    get to the next place, as an index into ``_KINDS``.
    """

    surfaces: Surfaces
    seconds: Seconds
    towards: NDArray[np.int64]
    kinds: NDArray[np.uint8]

    def legs(self, start: Point, metres: float = inf) -> tuple[Leg, ...]:
        """Return the legs of the route from the place nearest to ``start`` to the goal.

        Leave out the legs after the first ``metres`` of the route.
        """
        place = self.surfaces.nearest(start)
        legs = []
        point, length = self.surfaces.point(place), 0.0
        while self.towards[place] >= 0 and length <= metres:
            kind, place = _KINDS[self.kinds[place]], int(self.towards[place])
            next_point = self.surfaces.point(place)
            legs.append(Leg(kind, next_point))
            length += dist(point, next_point)
            point = next_point
        return tuple(legs)

    def seconds_from(self, x: Seconds, y: Seconds, z: Seconds) -> Seconds:
        """Return the seconds to the goal from points on the ground; all arrays are [n].

        The route from a point begins at the best of the places nearby. The result is infinite if
        none of them has a route.
        """
        surfaces, speed = self.surfaces, self.surfaces.kind.walk_speed
        _, rows, columns = self.seconds.shape
        column = np.floor((x - surfaces.origin[0]) / CELL).astype(np.intp)
        row = np.floor((y - surfaces.origin[1]) / CELL).astype(np.intp)
        best = np.full(x.shape, np.inf)
        near = np.abs(surfaces.heights[:, None] - z[None, :]) < 0.3
        for layer in np.flatnonzero(near.any(axis=1)):
            for dy in (-1, 0, 1):
                for dx in (-1, 0, 1):
                    r, c = _clamp(row + dy, rows), _clamp(column + dx, columns)
                    away = np.hypot(surfaces.xs[c] - x, surfaces.ys[r] - y) / speed
                    seconds = np.where(near[layer], self.seconds[layer, r, c] + away, np.inf)
                    best = np.minimum(best, seconds)
        return best


class Routes:
    """The routes of a level while the barriers with the indices ``shut`` are shut."""

    def __init__(self, level: StealthLevel, shut: Collection[int]) -> None:
        self.surfaces = Surfaces(level, shut)
        self._roomy = Surfaces(level, shut, margin=0.2).crouched
        self._into: list[list[tuple[int, float, int]]] = [[] for _ in range(self.surfaces.places.size)]
        for sources, targets, seconds, kinds in self._edges():
            columns = (column.tolist() for column in (sources, targets, seconds, kinds))
            for source, target, cost, kind in zip(*columns, strict=True):
                self._into[target].append((source, cost, kind))
        self._fields: dict[object, RouteField] = {}

    def field(self, goal: Point) -> RouteField:
        """Return the routes to ``goal`` from everywhere. The newest fields are cached."""
        if goal not in self._fields:
            self._store(goal, self._field(self.surfaces.near(goal, _GOAL)))
        return self._fields[goal]

    def _store(self, key: object, field: RouteField) -> None:
        # A goal may move, and then has a field for each of its places.
        if len(self._fields) >= _MOST_CACHED:
            del self._fields[next(iter(self._fields))]
        self._fields[key] = field

    def leads(self, start: Point, goal: Point) -> bool:
        """Whether a route leads from the place nearest to ``start`` to ``goal``."""
        return bool(np.isfinite(self.field(goal).seconds.flat[self.surfaces.nearest(start)]))

    def field_from(self, start: Point, goal: Point) -> RouteField:
        """Return the routes to ``goal`` if there is a route from ``start``.

        Otherwise return the routes to another place: the one nearest to ``goal`` among those that
        can be reached from ``start``.
        """
        field = self.field(goal)
        place = self.surfaces.nearest(start)
        if np.isfinite(field.seconds.flat[place]):
            return field
        key = (goal, place)
        if key not in self._fields:
            reached = min(
                self._reachable_places(place), key=lambda candidate: dist(self.surfaces.point(candidate), goal)
            )
            self._store(key, self._field(np.array([reached])))
        return self._fields[key]

    def _field(self, goals: NDArray[np.intp]) -> RouteField:
        """Return the fastest routes to any of ``goals``, by Dijkstra's algorithm, which begins at the goals.

        ``goals`` are flat indices of places.
        """
        seconds: Any = [inf] * self.surfaces.places.size
        towards, kinds = [-1] * len(seconds), [0] * len(seconds)
        queue = [(0.0, goal) for goal in goals.tolist()]
        for _, goal in queue:
            seconds[goal] = 0.0
        while queue:
            time, place = heappop(queue)
            if time > seconds[place]:
                continue
            for source, cost, kind in self._into[place]:
                if time + cost < seconds[source]:
                    seconds[source], towards[source], kinds[source] = time + cost, place, kind
                    heappush(queue, (time + cost, source))
        shape = self.surfaces.places.shape
        columns = np.array(seconds).reshape(shape), np.array(towards), np.array(kinds, dtype=np.uint8)
        return RouteField(self.surfaces, *columns)

    def _reachable_places(self, start: int) -> set[int]:
        """Return the places to which routes lead from the place ``start``, all as flat indices."""
        successors: dict[int, list[int]] = {}
        for target, sources in enumerate(self._into):
            for source, _, _ in sources:
                successors.setdefault(source, []).append(target)
        reached, pending = {start}, [start]
        while pending:
            for target in successors.get(pending.pop(), ()):
                if target not in reached:
                    reached.add(target)
                    pending.append(target)
        return reached

    # The next methods make groups of edges, each for one direction and one pair of layers. A group has arrays of
    # sources, targets, seconds and kinds.

    def _edges(self) -> Iterator[_Edges]:
        heights = self.surfaces.heights
        occupied = np.flatnonzero(self.surfaces.places.any(axis=(1, 2))).tolist()
        for layer in occupied:
            for target in occupied:
                up = float(heights[target] - heights[layer])
                if up > _CLIMB + 1e-6:
                    break
                for direction in _DIRECTIONS:
                    if abs(up) <= self.surfaces.kind.step_height + 1e-6:
                        yield self._walks(layer, target, direction)
                    if up > self.surfaces.kind.step_height + 1e-6:
                        yield from self._climbs(layer, target, direction)
                    elif up < 0.0:
                        yield from self._drops(layer, target, direction)
                    if up < 1e-6:
                        yield from self._leaps(layer, target, direction)

    def _walks(self, layer: int, target: int, direction: tuple[int, int]) -> _Edges:
        surfaces, kind = self.surfaces, self.surfaces.kind
        sources, targets = self._place_pairs(layer, target, direction, surfaces.places[layer])
        upright = surfaces.standing.ravel()[sources] & surfaces.standing.ravel()[targets]
        roomy = self._roomy.ravel()[targets]
        length = CELL * hypot(*direction)
        seconds = np.where(upright, length / kind.walk_speed, length / kind.crouch_speed)
        kinds = np.where(upright, _KINDS.index("walk"), _KINDS.index("crouch"))
        return sources, targets, np.where(roomy, seconds, seconds * _CLOSE_TO_WALL), kinds

    def _climbs(self, layer: int, target: int, direction: tuple[int, int]) -> Iterator[_Edges]:
        """Yield groups of edges for jumps from ``layer`` up to the higher layer ``target``.

        A layer is a height at which players can stand. Each group is for another distance, from two
        cells on.
        """
        surfaces = self.surfaces
        begin = surfaces.places[layer] & surfaces.standing[layer] & surfaces.standing[target]
        for steps, length in _reaches(direction, 2, _CLIMB_REACH):
            begin = begin & _shift(surfaces.standing[target], direction, steps - 1)
            yield self._edges_between(
                self._place_pairs(layer, target, direction, begin, steps), length, _JUMP_TIME, "climb"
            )

    def _drops(self, layer: int, target: int, direction: tuple[int, int]) -> Iterator[_Edges]:
        """Yield groups of edges for steps off a ledge in ``layer``, down to the layer ``target``.

        A layer is a height at which players can stand. Each group is for another distance.
        """
        surfaces = self.surfaces
        fall = sqrt(2 * float(surfaces.heights[layer] - surfaces.heights[target]) / surfaces.kind.gravity)
        column: Cells = np.logical_and.reduce(surfaces.standing[target : layer + 1])
        begin = surfaces.places[layer] & surfaces.standing[layer]
        for steps, length in _reaches(direction, 2, _DROP_REACH):
            begin = begin & _shift(surfaces.standing[layer], direction, steps - 1)
            lands = begin & _shift(column, direction, steps)
            yield self._edges_between(self._place_pairs(layer, target, direction, lands, steps), length, fall, "drop")

    def _leaps(self, layer: int, target: int, direction: tuple[int, int]) -> Iterator[_Edges]:
        """Yield groups of edges for jumps across a gap, to a ``target`` layer that is not higher.

        A layer is a height at which players can stand. Each group is for another distance.
        """
        surfaces = self.surfaces
        column: Cells = np.logical_and.reduce(surfaces.standing[target : layer + 1])
        begin = surfaces.places[layer] & surfaces.leaping[layer]
        walkable = begin
        for steps, length in _reaches(direction, 2, _LEAP_REACH):
            begin = begin & _shift(surfaces.leaping[layer], direction, steps - 1)
            walkable = walkable & _shift(surfaces.places[layer], direction, steps - 1)
            lands = begin & ~walkable & _shift(column, direction, steps)
            yield self._edges_between(
                self._place_pairs(layer, target, direction, lands, steps), length, _JUMP_TIME, "leap"
            )

    def _place_pairs(
        self, layer: int, target: int, direction: tuple[int, int], begin: Cells, steps: int = 1
    ) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
        """Return pairs of places: the flat indices of the first places, and those of the second.

        The first place of a pair is in ``layer``, a height at which players can stand, within the
        mask ``begin`` [rows, columns]. The second is in the layer ``target``, ``steps`` cells away
        in ``direction``.
        """
        _, rows, columns = self.surfaces.places.shape
        places = begin & _shift(self.surfaces.places[target], direction, steps)
        row, column = np.nonzero(places)
        sources = (layer * rows + row) * columns + column
        targets = (target * rows + row + steps * direction[0]) * columns + column + steps * direction[1]
        return sources, targets

    def _edges_between(
        self, pairs: tuple[NDArray[np.intp], NDArray[np.intp]], length: float, extra: float, kind: Kind
    ) -> _Edges:
        sources, targets = pairs
        seconds = np.full(sources.shape, length / self.surfaces.kind.walk_speed + extra)
        return sources, targets, seconds, np.full(sources.shape, _KINDS.index(kind))


@lru_cache(maxsize=32)
def routes_of(level: StealthLevel, shut: frozenset[int]) -> Routes:
    """Return the routes of a level while the barriers with the indices ``shut`` are shut.

    They are cached per process.
    """
    return Routes(level, shut)


def shut_barriers(snapshot: Snapshot) -> frozenset[int]:
    """Return the indices of the barriers that are shut in a snapshot."""
    return frozenset(index for index, is_open in enumerate(snapshot.open) if not is_open)


def _reaches(direction: tuple[int, int], least: int, reach: float) -> Iterator[tuple[int, float]]:
    """Yield distances in ``direction``: each as a number of cells, and as its length in metres.

    The numbers are ``least``, ``least + 1``, and so on, up to a length of ``reach`` metres.
    """
    length = CELL * hypot(*direction)
    for steps in range(least, int(reach / length + 1e-6) + 1):
        yield steps, steps * length


def _clamp(index: NDArray[np.intp], count: int) -> NDArray[np.intp]:
    """Return the indices, clamped to the range from 0 to ``count - 1``."""
    return np.minimum(np.maximum(index, 0), count - 1)


def _shift(cells: Cells, direction: tuple[int, int], steps: int) -> Cells:
    """Return a mask in which each cell has the value of the cell ``steps`` away in ``direction``.

    A cell is False if the other cell is beyond the border.
    """
    dy, dx = direction[0] * steps, direction[1] * steps
    rows, columns = cells.shape
    shifted = np.zeros_like(cells)
    if abs(dy) < rows and abs(dx) < columns:
        shifted[max(0, -dy) : rows - max(0, dy), max(0, -dx) : columns - max(0, dx)] = cells[
            max(0, dy) : rows + min(0, dy), max(0, dx) : columns + min(0, dx)
        ]
    return shifted
