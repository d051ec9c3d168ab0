"""The semantic map: the cell types around the agent at the height of its body.

The map does not turn with the agent: its first axis goes north (y), its second east (x), and the
agent is in the middle cell. What stands still is cut out of arrays of the whole level
(:class:`~tltl_runtime.stealth.observation.voxels.Voxels`), which takes 2 µs. Each mover or enemy in
the map takes about 2 µs more.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil
from typing import Final

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.game.sensors import MapSensor
from tltl_runtime.stealth.level import Point, StealthLevel
from tltl_runtime.stealth.observation.voxels import BELOW, CROUCHED, LAYER, STANDING, Voxels
from tltl_runtime.stealth.world.geometry import Bounds

_ENEMY_RADIUS: Final = 0.3
_ENEMY_HEIGHT: Final = 1.8
_TOUCH: Final = 1e-6


class SemanticMap:
    """The semantic map of a level: the types of the cells around the player.

    ``sensor`` gives the size of the map and its types; by default, it is the level's own map
    sensor. Raises ValueError if there is neither, or if a cell type is unknown.
    """

    def __init__(self, level: StealthLevel, sensor: MapSensor | None = None) -> None:
        sensor = level.sensors.map if sensor is None else sensor
        if sensor is None:
            raise ValueError(f"the sensors of the level {level.name} include no map")
        self.sensor = sensor
        self.voxels = Voxels(level, sensor)
        self._barriers = len(level.barriers)
        self._mover = self.voxels.ids.get("mover", 0)
        self._enemy = self.voxels.ids.get("enemy", 0)
        self._rows_of_types = np.eye(len(sensor.types) + 1, dtype=np.uint8)[1:]
        grid, margin = self.voxels.grid, self.voxels.margin
        self._origin = (grid.x, grid.y, grid.z)
        self._per_metre = 1.0 / grid.cell
        self._side = sensor.extent * grid.cell
        self._most_column = grid.columns - 2 * margin - 1
        self._most_row = grid.rows - 2 * margin - 1
        self._most_layer = grid.layers - 1
        self.reset()

    def reset(self) -> None:
        """Prepare the map for a new episode, in which all barriers are shut."""
        self._shut = set(range(self._barriers))
        self._layers = self.voxels.layers(self._shut)

    def set_open(self, barrier: int, opened: bool) -> None:
        """Show the barrier with this index as open or shut from now on."""
        (self._shut.discard if opened else self._shut.add)(barrier)
        self._layers = self.voxels.layers(self._shut)

    def look(
        self,
        position: Point,
        crouching: bool = False,
        movers: Sequence[Bounds] = (),
        enemies: Sequence[Point] = (),
    ) -> NDArray[np.uint8]:
        """Return the types of the cells around the player, whose feet are at ``position``.

        The result is uint8 [extent, extent]: 0 for no type, else 1 + the index of the type in
        ``sensor.types``. ``movers`` are the current corners of the movers' boxes, ``enemies`` the
        positions of the enemies' feet. A position outside the bounds counts as in the nearest cell
        inside.
        """
        x, y, z = position
        x0, y0, z0 = self._origin
        margin, extent, scale = self.voxels.margin, self.sensor.extent, self._per_metre
        column = min(max(int((x - x0) * scale) - margin, 0), self._most_column)
        row = min(max(int((y - y0) * scale) - margin, 0), self._most_row)
        layer = min(max(int((z - z0) / LAYER + 0.5), 0), self._most_layer)
        window = self._layers[crouching][layer][row : row + extent, column : column + extent]
        ids: NDArray[np.uint8] = window.copy()
        west, south = x0 + column / scale, y0 + row / scale
        bottom, top = z - BELOW, z + (CROUCHED if crouching else STANDING)
        if self._mover:
            for (a, b, c), (d, e, f) in movers:
                if c < top and f > bottom:
                    self._stamp(ids, a - west, b - south, d - west, e - south, self._mover)
        if self._enemy:
            for a, b, c in enemies:
                if c < top and c + _ENEMY_HEIGHT > bottom:
                    a, b = a - west, b - south
                    self._stamp(
                        ids, a - _ENEMY_RADIUS, b - _ENEMY_RADIUS, a + _ENEMY_RADIUS, b + _ENEMY_RADIUS, self._enemy
                    )
        return ids

    def one_hot(self, ids: NDArray[np.uint8]) -> NDArray[np.uint8]:
        """Convert a map from :meth:`look` to one layer per type, uint8 [types, extent, extent].

        A layer is 1 where a cell is of its type, else 0.
        """
        layers: NDArray[np.uint8] = self._rows_of_types.take(ids, axis=1)
        return layers

    def _stamp(self, ids: NDArray[np.uint8], a: float, b: float, c: float, d: float, number: int) -> None:
        """Write ``number`` into the cells of ``ids`` that overlap a rectangle.

        The rectangle's west, south, east and north sides are ``a``, ``b``, ``c`` and ``d``, in
        metres from the map's south-west corner.
        """
        if a < self._side and b < self._side and c > 0.0 and d > 0.0:
            scale = self._per_metre
            west = int(a * scale + _TOUCH) if a > 0.0 else 0
            south = int(b * scale + _TOUCH) if b > 0.0 else 0
            ids[south : ceil(d * scale - _TOUCH), west : ceil(c * scale - _TOUCH)] = number
