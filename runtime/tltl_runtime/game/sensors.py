"""The sensors of an agent, as data."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from tltlc.api import record


@record
class MapSensor:
    """The semantic map around the agent: ``extent`` by ``extent`` cells of ``cell`` metres.

    ``extent`` is odd.
    """

    types: tuple[str, ...]
    cell: float
    extent: int


@record
class Sensors:
    """The observations: vectors to ``entities``, values of ``variables`` (signals), the map."""

    entities: tuple[str, ...]
    variables: tuple[str, ...]
    map: MapSensor | None


SensorChoice = Sensors | Mapping[str, Any]
"""A record, or a mapping with some of its fields; ``map`` may be a mapping, too."""
