"""Predict where movers (moving boxes) will be, from their paths and from their places in snapshots."""

from __future__ import annotations

from collections.abc import Sequence
from math import dist
from typing import Final

from tltl_runtime.stealth.level import Box, Mover, Point, StealthLevel
from tltl_runtime.stealth.snapshot import Snapshot
from tltl_runtime.stealth.world.geometry import box_around
from tltl_runtime.stealth.world.mover_path import MoverPath
from tltl_runtime.stealth.world.player import DECISION, SUBSTEPS

_TOLERANCE: Final = 1e-6
"""A predicted position is right if the mover is less than this far from it, in metres."""


class Clocks:
    """The clocks of a level's movers (moving boxes): how far each mover is in its cycle, in seconds.

    A clock stands still while the player blocks the mover.
    """

    def __init__(self, level: StealthLevel) -> None:
        self._movers = level.movers
        self._paths = [MoverPath(mover) for mover in level.movers]
        self._clocks = [mover.offset for mover in level.movers]
        self._time = 0.0

    def see(self, snapshot: Snapshot) -> None:
        """Update the clocks from the current snapshot; call this after each time step."""
        passed = snapshot.time - self._time
        self._time = snapshot.time
        for index, (path, place) in enumerate(zip(self._paths, snapshot.movers, strict=True)):
            lags = [passed - step * DECISION / SUBSTEPS for step in range(round(passed / DECISION * SUBSTEPS) + 1)]
            elapsed = next(
                (lag for lag in lags if dist(path.position_at(self._clocks[index] + lag), place) < _TOLERANCE), passed
            )
            self._clocks[index] += elapsed

    def swept_boxes(self, first: int, last: int | None = None) -> list[Box]:
        """Return for each mover the bounding box of its motion in the time steps ``first`` to ``last``.

        Time steps are counted from now: the next one is 0. By default, ``last`` is ``first``.
        """
        boxes = []
        for mover, path, clock in zip(self._movers, self._paths, self._clocks, strict=True):
            steps = range(first, (first if last is None else last) + 2)
            corners = [box_around(path.position_at(clock + step * DECISION), mover.size) for step in steps]
            boxes.append(_hull(corners))
        return boxes


def swept_bounds(mover: Mover) -> Box:
    """Return the bounding box of all positions that a mover (a moving box) takes on its path."""
    return _hull([box_around(place, mover.size) for place in mover.path])


def _hull(boxes: Sequence[tuple[Point, Point]]) -> Box:
    """Return the bounding box of boxes, each given by its low and its high corner."""
    lows, highs = [box[0] for box in boxes], [box[1] for box in boxes]
    return Box(
        (min(low[0] for low in lows), min(low[1] for low in lows), min(low[2] for low in lows)),
        (max(high[0] for high in highs), max(high[1] for high in highs), max(high[2] for high in highs)),
    )
