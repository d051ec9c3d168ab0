"""What stands still in a level, as layers of cells from which semantic maps are cut.

A level is cut into square cells and, every quarter of a metre in height, into layers. A layer is
for a body whose feet are at its height. For each cell it says what the body would meet there, from
its head down to the ground on which it stands. There is one set of layers for a standing body and
one for a crouched body, so a low passage is free only in the second set. A cell has the type of an
object that overlaps it, however little. If several objects overlap the cell, it has the type that
comes last in CELL_TYPES.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from math import ceil, floor
from typing import Final

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.game.sensors import MapSensor
from tltl_runtime.stealth.level import Box, Point, StealthLevel
from tltl_runtime.stealth.levels.level_tables import CELL_TYPES
from tltlc.api import record

LAYER: Final = 0.25
"""The height of a layer, in metres."""
STANDING: Final = 1.8
CROUCHED: Final = 0.9
"""The heights of the player's body, standing and crouched, in metres."""
BELOW: Final = 0.1
"""The depth below the feet, in metres, that a layer covers, so that it shows the ground under the body."""

_POINT_HEIGHT: Final = 1.0
_TOUCH: Final = 1e-6

Layers = tuple[tuple[NDArray[np.uint8], ...], tuple[NDArray[np.uint8], ...]]
"""The layers for a standing body, and those for a crouched body.

Both are tuples of layers, the lowest first; each layer is uint8 [rows, columns].
"""


@record
class VoxelGrid:
    """The position and size of a grid of cells, in metres.

    The cell in row 0 and column 0 has its south-west corner at ``x``, ``y``. Layer 0 is for a body
    whose feet are at height ``z``. Each cell is ``cell`` wide.
    """

    x: float
    y: float
    z: float
    cell: float
    rows: int
    columns: int
    layers: int


class Voxels:
    """The layers of a level, one set for each set of shut barriers.

    A layer says what a body at one height would meet in each cell. It has a margin of ``margin``
    empty cells around the level, so that a map at the border can be cut out of the layer, too.
    ``ids`` has the number of each type in the layers. Raises ValueError for a type that is not in
    CELL_TYPES.
    """

    def __init__(self, level: StealthLevel, sensor: MapSensor) -> None:
        unknown = [name for name in sensor.types if name not in CELL_TYPES]
        if unknown:
            raise ValueError(f"a map has no type {unknown[0]!r}: there are {', '.join(CELL_TYPES)}")
        self.level = level
        self.ids = {name: 1 + index for index, name in enumerate(sensor.types)}
        self.margin = sensor.extent // 2
        (x0, y0, z0), (x1, y1, z1) = level.bounds.low, level.bounds.high
        bottom = floor(z0 / LAYER)
        self.grid = VoxelGrid(
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
        """Return the layers while the barriers with the indices ``shut`` are shut.

        They are cached and read-only.
        """
        key = frozenset(shut)
        if key not in self._layers:
            things = sorted(self._typed_boxes(key), key=lambda thing: CELL_TYPES.index(thing[0]))
            known = [(self.ids[name], box) for name, box in things if name in self.ids]
            self._layers[key] = (self._draw(known, STANDING), self._draw(known, CROUCHED))
        return self._layers[key]

    def _typed_boxes(self, shut: Collection[int]) -> Iterator[tuple[str, Box]]:
        """Yield the cell type and the box of each object in the level that stands still."""
        yield from ((solid.kind, solid.box) for solid in self.level.solids)
        yield from (("switch", self._point_box(switch.position)) for switch in self.level.switches)
        yield from (("exit", self._point_box(exit_.position)) for exit_ in self.level.exits)
        for index, barrier in enumerate(self.level.barriers):
            if index in shut:
                yield "laser" if barrier.kind == "laser" else "barrier", barrier.box

    def _point_box(self, position: Point) -> Box:
        """Return a box for a thing at ``position``: on the map it takes one cell, in each layer that it reaches."""
        x, y, z = position
        return Box((x, y, z), (x + 10 * _TOUCH, y + 10 * _TOUCH, z + _POINT_HEIGHT))

    def _draw(self, things: list[tuple[int, Box]], height: float) -> tuple[NDArray[np.uint8], ...]:
        grid = self.grid
        layers = np.zeros((grid.layers, grid.rows, grid.columns), dtype=np.uint8)
        for number, box in things:
            columns = _cell_range(box.low[0], box.high[0], grid.x, grid.cell)
            rows = _cell_range(box.low[1], box.high[1], grid.y, grid.cell)
            for layer in range(grid.layers):
                feet = grid.z + layer * LAYER
                if box.high[2] > feet - BELOW + _TOUCH and box.low[2] < feet + height - _TOUCH:
                    layers[layer, rows, columns] = number
        layers.flags.writeable = False
        return tuple(layers)


def _cell_range(low: float, high: float, origin: float, cell: float) -> slice:
    """Return the range of cells that overlap the inside of the interval from ``low`` to ``high``.

    Cells are ``cell`` wide, and the first one begins at ``origin``.
    """
    return slice(max(0, floor((low - origin) / cell + _TOUCH)), max(0, ceil((high - origin) / cell - _TOUCH)))
