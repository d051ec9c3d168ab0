"""The agent's observation: vectors to entities, values of signals, and the semantic map."""

from __future__ import annotations

from math import dist, pi
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from gymnasium import spaces

from tltl_runtime.game.sensors import SensorChoice
from tltl_runtime.stealth.level import StealthLevel
from tltl_runtime.stealth.observation.semantic_map import SemanticMap
from tltl_runtime.stealth.observation.sensors import choose_sensors
from tltl_runtime.stealth.signals import AXES, LevelSignal, Reader, level_signals, position_readers

if TYPE_CHECKING:
    from tltl_runtime.stealth.simulation import Simulation

_HALF_TIME_S: Final = 60.0
"""The time t is observed as t / (t + this), in seconds, so that it stays below 1."""


class Observer:
    """Computes the agent's observations.

    The sensors are those that the level declares, or those that ``sensors`` selects instead. Call
    ``look`` with a simulation of that level. ``space`` is a Dict with these keys; a key is missing
    if there are no sensors for it:

    - ``entities`` float32 (3 n,): the vectors from the player's feet to the entities, divided by
      the diagonal of the bounds, in [-1, 1].
    - ``variables`` float32 (n,), in [-1, 1]: truth values as 0 or 1, lengths divided by the
      diagonal, positions as a fraction of the bounds, angles divided by pi, the time t as t / (t +
      60 s). All other signals and all aliases are unchanged, but cut off at -1 and 1.
    - ``map`` uint8 (types, extent, extent): 1 where a cell is of that type; rows go north, columns
      east.

    Raises:
        TltlError: TLT0815, ``sensors`` is invalid, or names something that the level does not have.
    """

    def __init__(self, level: StealthLevel, sensors: SensorChoice | None = None) -> None:
        self.sensors = sensors = choose_sensors(level, sensors)
        places, signals, aliases = position_readers(level), level_signals(level), dict(level.signals)
        self._places = [places[name] for name in sensors.entities]
        # The value of an alias is not scaled.
        self._variables = [
            signals[name].read if name in aliases else _scaled_reader(signals[name], level)
            for name in sensors.variables
        ]
        diagonal = dist(level.bounds.low, level.bounds.high)
        sizes = [diagonal] * 3 * len(self._places) + [1.0] * len(self._variables)
        self._sizes = np.array(sizes, dtype=np.float32)
        # Use arrays as limits: numpy's clip takes three times as long with Python floats.
        self._least, self._most = np.full_like(self._sizes, -1.0), np.ones_like(self._sizes)
        self._map = SemanticMap(level, sensors.map) if sensors.map else None
        self._open: list[bool] = []
        self.space = spaces.Dict(self._spaces())

    def look(self, game: Simulation) -> dict[str, Any]:
        """Return the current observation, an element of ``space``."""
        x, y, z = game.world.player.position
        vectors: list[float] = []
        for place in self._places:
            px, py, pz = place(game)
            vectors += (px - x, py - y, pz - z)
        values = [read(game) for read in self._variables]
        row = np.array(vectors + values, dtype=np.float32)
        row /= self._sizes
        row.clip(self._least, self._most, row)
        observation: dict[str, Any] = {}
        if vectors:
            observation["entities"] = row[: len(vectors)]
        if values:
            observation["variables"] = row[len(vectors) :]
        if self._map is not None:
            observation["map"] = self._map_layers(game, self._map)
        return observation

    def _map_layers(self, game: Simulation, semantic_map: SemanticMap) -> Any:
        if game.open != self._open:
            self._open = list(game.open)
            semantic_map.reset()
            for barrier, is_open in enumerate(self._open):
                if is_open:
                    semantic_map.set_open(barrier, True)
        player = game.world.player
        ids = semantic_map.look(player.position, player.crouching, game.world.mover_boxes(), game.enemies.positions)
        return semantic_map.one_hot(ids)

    def _spaces(self) -> dict[str, spaces.Space[Any]]:
        keys: dict[str, spaces.Space[Any]] = {}
        if self._places:
            keys["entities"] = spaces.Box(-1.0, 1.0, (3 * len(self._places),), np.float32)
        if self._variables:
            keys["variables"] = spaces.Box(-1.0, 1.0, (len(self._variables),), np.float32)
        if self._map is not None:
            sensor = self._map.sensor
            keys["map"] = spaces.Box(0, 1, (len(sensor.types), sensor.extent, sensor.extent), np.uint8)
        return keys


def _scaled_reader(signal: LevelSignal, level: StealthLevel) -> Reader:
    """Return a function that reads a signal from a simulation, scaled as :class:`Observer` says."""
    low, high, read = level.bounds.low, level.bounds.high, signal.read
    if signal.base == "time":
        return lambda game: game.time / (game.time + _HALF_TIME_S)
    if signal.base in AXES:
        axis = AXES[signal.base]
        return lambda game: (read(game) - low[axis]) / (high[axis] - low[axis])
    if signal.base == "distance":
        diagonal = dist(low, high)
        return lambda game: read(game) / diagonal
    if signal.base == "bearing":
        return lambda game: read(game) / pi
    return read
