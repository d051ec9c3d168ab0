"""Where moving obstacles will be: their paths are known, their clocks are told by looking at them."""

from __future__ import annotations

from collections.abc import Sequence
from math import dist
from typing import Final

from tltl_runtime.stealth.level import Box, Level, Mover, Point
from tltl_runtime.stealth.snapshot import Snapshot
from tltl_runtime.stealth.world.geometry import around
from tltl_runtime.stealth.world.player import DECISION, SUBSTEPS
from tltl_runtime.stealth.world.way import Way

_SEEN: Final = 1e-6
"""Metres from where a clock puts a mover at which it is somewhere else."""


class Clocks:
    """The clock of each mover, in seconds of its own: it stands still while the player is in the mover's way."""

    def __init__(self, level: Level) -> None:
        self._movers = level.movers
        self._ways = [Way(mover) for mover in level.movers]
        self._clocks = [mover.offset for mover in level.movers]
        self._time = 0.0

    def see(self, snapshot: Snapshot) -> None:
        """Set the clocks by what there is to see; to be called after each decision."""
        passed = snapshot.time - self._time
        self._time = snapshot.time
        for index, (way, place) in enumerate(zip(self._ways, snapshot.movers, strict=True)):
            lags = [passed - step * DECISION / SUBSTEPS for step in range(round(passed / DECISION * SUBSTEPS) + 1)]
            now = next((lag for lag in lags if dist(way.at(self._clocks[index] + lag), place) < _SEEN), passed)
            self._clocks[index] += now

    def swept(self, first: int, last: int | None = None) -> list[Box]:
        """The box that each mover sweeps from the beginning of decision ``first`` from now to the end of ``last``."""
        boxes = []
        for mover, way, clock in zip(self._movers, self._ways, self._clocks, strict=True):
            steps = range(first, (first if last is None else last) + 2)
            corners = [around(way.at(clock + step * DECISION), mover.size) for step in steps]
            boxes.append(_hull(corners))
        return boxes


def reach_of(mover: Mover) -> Box:
    """The box of all places where a moving obstacle can be."""
    return _hull([around(place, mover.size) for place in mover.path])


def _hull(boxes: Sequence[tuple[Point, Point]]) -> Box:
    """The least box that holds all of some boxes, each given by its corners."""
    lows, highs = [box[0] for box in boxes], [box[1] for box in boxes]
    return Box(
        (min(low[0] for low in lows), min(low[1] for low in lows), min(low[2] for low in lows)),
        (max(high[0] for high in highs), max(high[1] for high in highs), max(high[2] for high in highs)),
    )
