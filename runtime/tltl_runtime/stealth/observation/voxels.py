"""What stands where, as cells of types: the ground of the semantic map.

A level is cut into square cells and, every quarter of a metre in height, into layers.  A layer tells for each cell
what meets a body whose feet are at its height, down to what it stands on; there is one set of layers for a standing
body and one for a crouched one, so a low passage is free in the second alone.  A cell that a thing meets at all is
of its type; where several meet, of the one that CELL_TYPES names last.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from math import ceil, floor
from typing import Final

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.stealth.level import Box, Level, MapSensor, Point
from tltl_runtime.stealth.levels.parts import CELL_TYPES
from tltlc.core.record import record

LAYER: Final = 0.25
"""The height of a layer."""
STANDING: Final = 1.8
CROUCHED: Final = 0.9
"""The heights of the player's body."""
BELOW: Final = 0.1
"""How far below its feet a body meets what it stands on."""

_POINT_HEIGHT: Final = 1.0
_TOUCH: Final = 1e-6

Layers = tuple[tuple[NDArray[np.uint8], ...], tuple[NDArray[np.uint8], ...]]
"""For a standing and for a crouched body, the layers from the lowest up, each uint8 [rows, columns]."""


@record
class Frame:
    """Where the cells lie: row 0, column 0 begins at ``x``, ``y``; layer 0 is for feet at ``z``."""

    x: float
    y: float
    z: float
    cell: float
    rows: int
    columns: int
    layers: int


class Voxels:
    """The layers of a level, one set for each set of barriers that are shut.

    Each layer has ``margin`` cells of nothing around the level.  Raises ValueError for a type that is not in
    CELL_TYPES.
    """

    def __init__(self, level: Level, sensor: MapSensor) -> None:
        unknown = [name for name in sensor.types if name not in CELL_TYPES]
        if unknown:
            raise ValueError(f"a map knows no type {unknown[0]!r}: it can tell {', '.join(CELL_TYPES)}")
        self.level = level
        self.ids = {name: 1 + index for index, name in enumerate(sensor.types)}
        self.margin = sensor.extent // 2
        (x0, y0, z0), (x1, y1, z1) = level.bounds.low, level.bounds.high
        bottom = floor(z0 / LAYER)
        self.frame = Frame(
            x=x0 - self.margin * sensor.cell,
            y=y0 - self.margin * sensor.cell,
            z=bottom * LAYER,
            cell=sensor.cell,
            rows=ceil((y1 - y0) / sensor.cell - _TOUCH) + 2 * self.margin,
            columns=ceil((x1 - x0) / sensor.cell - _TOUCH) + 2 * self.margin,
            layers=ceil(z1 / LAYER) - bottom,
        )
        self._layers: dict[frozenset[int], Layers] = {}

    def layers(self, shut: Collection[int]) -> Layers:
        """The layers while the barriers with these indices are shut; they are made once and not to be changed."""
        key = frozenset(shut)
        if key not in self._layers:
            things = sorted(self._things(key), key=lambda thing: CELL_TYPES.index(thing[0]))
            known = [(self.ids[name], box) for name, box in things if name in self.ids]
            self._layers[key] = (self._drawn(known, STANDING), self._drawn(known, CROUCHED))
        return self._layers[key]

    def _things(self, shut: Collection[int]) -> Iterator[tuple[str, Box]]:
        """What stands still, with its type."""
        yield from ((solid.kind, solid.box) for solid in self.level.solids)
        yield from (("switch", self._around(switch.position)) for switch in self.level.switches)
        yield from (("exit", self._around(each.position)) for each in self.level.exits)
        for index, barrier in enumerate(self.level.barriers):
            if index in shut:
                yield "laser" if barrier.kind == "laser" else "barrier", barrier.box

    def _around(self, position: Point) -> Box:
        """A box in the one cell that holds a position."""
        x, y, z = position
        return Box((x, y, z), (x + 10 * _TOUCH, y + 10 * _TOUCH, z + _POINT_HEIGHT))

    def _drawn(self, things: list[tuple[int, Box]], height: float) -> tuple[NDArray[np.uint8], ...]:
        frame = self.frame
        drawn = np.zeros((frame.layers, frame.rows, frame.columns), dtype=np.uint8)
        for number, box in things:
            columns = _covered(box.low[0], box.high[0], frame.x, frame.cell)
            rows = _covered(box.low[1], box.high[1], frame.y, frame.cell)
            for layer in range(frame.layers):
                feet = frame.z + layer * LAYER
                if box.high[2] > feet - BELOW + _TOUCH and box.low[2] < feet + height - _TOUCH:
                    drawn[layer, rows, columns] = number
        drawn.flags.writeable = False
        return tuple(drawn)


def _covered(low: float, high: float, origin: float, cell: float) -> slice:
    """The cells that the inside of an interval meets."""
    return slice(max(0, floor((low - origin) / cell + _TOUCH)), max(0, ceil((high - origin) / cell - _TOUCH)))
