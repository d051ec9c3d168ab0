"""The positions of movers (boxes of a level that move along a path) over time."""

from __future__ import annotations

from bisect import bisect_right
from itertools import pairwise
from math import sqrt

from tltl_runtime.stealth.level import Mover, Point


class MoverPath:
    """Computes the position of a mover from the time that it has spent on its path.

    A mover is a box that moves to the end of its path and back, or in a loop if the path is closed.
    """

    def __init__(self, mover: Mover) -> None:
        path = mover.path
        stops = [*path, path[0]] if mover.closed else [*path, *path[-2::-1]]
        self._first = path[0]
        self._legs: list[tuple[float, Point, Point, float]] = []
        self._pause = mover.pause
        self._lap = 0.0
        for start, end in pairwise(stops):
            along = (end[0] - start[0], end[1] - start[1], end[2] - start[2])
            length = sqrt(sum(part**2 for part in along))
            self._legs.append((self._lap, start, along, length / mover.speed))
            self._lap += mover.pause + length / mover.speed
        self._begins = [leg[0] for leg in self._legs]

    def position_at(self, clock: float) -> Point:
        """Return the centre of the mover ``clock`` seconds after the start of its cycle.

        At each point of the path, the mover first rests, and then moves to the next point. After the
        last point, the cycle starts again. The ``offset`` of the mover, with which its cycle is ahead
        of the episode, is not added here.
        """
        if self._lap <= 0.0:
            return self._first
        time = clock % self._lap
        begin, (x, y, z), (dx, dy, dz), duration = self._legs[bisect_right(self._begins, time) - 1]
        gone = time - begin - self._pause
        if gone <= 0.0 or duration <= 0.0:
            return x, y, z
        share = min(1.0, gone / duration)
        return x + share * dx, y + share * dy, z + share * dz
