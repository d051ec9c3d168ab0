"""The sensors of an agent: which parts of a level it observes."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from tltlc.api import record


@record
class MapSensor:
    """A map of the things around the agent: ``extent`` by ``extent`` cells of ``cell`` metres.

    ``extent`` is odd, so that the agent is in the middle cell. ``types`` are the types of things that
    the map shows, such as ``wall``.
    """

    types: tuple[str, ...]
    cell: float
    extent: int


@record
class Sensors:
    """What an agent observes of a level: vectors to entities, values of signals, and a map.

    ``entities`` are the names of the entities, and ``variables`` those of the signals. ``map`` is None if
    the agent has no map.
    """

    entities: tuple[str, ...]
    variables: tuple[str, ...]
    map: MapSensor | None


NO_SENSORS: Final = Sensors((), (), None)
"""The sensors of agents in games whose observations cannot be chosen."""


def sensor_shapes(sensors: Sensors) -> dict[str, tuple[int, ...]]:
    """Return the shapes of the parts of an observation that come from ``sensors``.

    The keys are ``entities``, ``variables`` and ``map``. Sensors that are empty have no part.
    """
    shapes: dict[str, tuple[int, ...]] = {}
    if sensors.entities:
        shapes["entities"] = (3 * len(sensors.entities),)
    if sensors.variables:
        shapes["variables"] = (len(sensors.variables),)
    if sensors.map is not None:
        shapes["map"] = (len(sensors.map.types), sensors.map.extent, sensors.map.extent)
    return shapes


SensorChoice = Sensors | Mapping[str, Any]
"""All sensors, or a mapping with some fields of :class:`Sensors`.

The level's own sensors give the remaining fields. ``map`` may be a mapping with some fields of
:class:`MapSensor`; None removes the map.
"""
