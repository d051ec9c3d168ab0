"""What the agent senses of the game: vectors to entities, values of variables, and the semantic map."""

from __future__ import annotations

from math import dist, pi
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from tltl_runtime.stealth.level import Level
from tltl_runtime.stealth.senses.semantic_map import SemanticMap
from tltl_runtime.stealth.senses.sensors import SensorChoice, chosen
from tltl_runtime.stealth.signals import entities, readers

if TYPE_CHECKING:
    from tltl_runtime.stealth.game import Game

_HALF_TIME_S: Final = 60.0
"""The time that is sensed as 0.5: it has no end, and what is sensed has."""


class Senses:
    """The senses that a level declares, or ``sensors`` in place of them; ``look`` follows a game of that level.

    ``space`` is a Dict, without the keys of which nothing is declared:

    - ``entities`` float32 (3 n,), the vectors from the player's feet, over the diagonal of the bounds, in [-1, 1];
    - ``variables`` float32 (n,): truth as 0 or 1, lengths over the diagonal, positions as a share of the bounds,
      angles over pi, and the time t as t / (t + 60 s); the others as they are, all in [-1, 1];
    - ``map`` uint8 (types, extent, extent), 1 where a cell is of that type; rows run north, columns east.

    Raises:
        TltlError: TLT0815, where ``sensors`` say what the level does not have.
    """

    def __init__(self, level: Level, sensors: SensorChoice | None = None) -> None:
        self.sensors = sensors = chosen(level, sensors)
        places, signals = entities(level), readers(level)
        self._places = [places[name] for name in sensors.entities]
        self._variables = [(signals[name], *_scale(name, level)) for name in sensors.variables]
        self._diagonal = dist(level.bounds.low, level.bounds.high)
        self._map = SemanticMap(level, sensors.map) if sensors.map else None
        self._open: tuple[bool, ...] = ()
        self.space = spaces.Dict(self._spaces())

    def look(self, game: Game) -> dict[str, Any]:
        """What is sensed now, in ``space``."""
        found: dict[str, Any] = {}
        if self._places:
            x, y, z = game.world.player.position
            vectors = [
                part for place in self._places for px, py, pz in (place(game),) for part in (px - x, py - y, pz - z)
            ]
            found["entities"] = _clamped(np.array(vectors, dtype=np.float32) / self._diagonal)
        if self._variables:
            values = [_share(read(game), low, size) for read, low, size in self._variables]
            found["variables"] = _clamped(np.array(values, dtype=np.float32))
        if self._map is not None:
            found["map"] = self._see(game, self._map)
        return found

    def _see(self, game: Game, semantic_map: SemanticMap) -> Any:
        opened = tuple(game.open)
        if opened != self._open:
            semantic_map.reset()
            for barrier, is_open in enumerate(opened):
                if is_open:
                    semantic_map.set_open(barrier, True)
            self._open = opened
        player = game.world.player
        ids = semantic_map.look(player.position, player.crouching, game.mover_boxes(), game.enemies.positions)
        return semantic_map.one_hot(ids)

    def _spaces(self) -> dict[str, spaces.Space[Any]]:
        found: dict[str, spaces.Space[Any]] = {}
        if self._places:
            found["entities"] = spaces.Box(-1.0, 1.0, (3 * len(self._places),), np.float32)
        if self._variables:
            found["variables"] = spaces.Box(-1.0, 1.0, (len(self._variables),), np.float32)
        if self._map is not None:
            sensor = self._map.sensor
            found["map"] = spaces.Box(0, 1, (len(sensor.types), sensor.extent, sensor.extent), np.uint8)
        return found


def _clamped(values: NDArray[np.float32]) -> NDArray[np.float32]:
    """``values`` themselves, put into [-1, 1]; a fifth of the time of ``np.clip``."""
    np.maximum(values, -1.0, out=values)
    np.minimum(values, 1.0, out=values)
    return values


def _share(value: float, low: float, size: float) -> float:
    """A value as a share of what it can be; of no size, as a share of an open end."""
    return (value - low) / size if size else value / (value + _HALF_TIME_S)


def _scale(name: str, level: Level) -> tuple[float, float]:
    """The least value and the size of the range in which a signal is sensed; size 0 where it has no end."""
    low, high = level.bounds.low, level.bounds.high
    if name == "time":
        return 0.0, 0.0
    if name.startswith("position."):
        axis = "xyz".index(name[-1])
        return low[axis], high[axis] - low[axis]
    if name.startswith("distance("):
        return 0.0, dist(low, high)
    return 0.0, pi if name.startswith("bearing(") else 1.0
