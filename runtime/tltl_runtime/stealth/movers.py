"""Where moving obstacles will be: their paths are known, their clocks are told by looking at them."""

from __future__ import annotations

from math import dist
from typing import Final

from tltl_runtime.stealth.game import Snapshot
from tltl_runtime.stealth.geometry import around
from tltl_runtime.stealth.level import Box, Level
from tltl_runtime.stealth.physics import SUBSTEPS
from tltl_runtime.stealth.player import DECISION
from tltl_runtime.stealth.way import Way

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
            low = tuple(min(corner[0][axis] for corner in corners) for axis in range(3))
            high = tuple(max(corner[1][axis] for corner in corners) for axis in range(3))
            boxes.append(Box((low[0], low[1], low[2]), (high[0], high[1], high[2])))
        return boxes
