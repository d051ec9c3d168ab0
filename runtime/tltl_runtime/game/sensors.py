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
    """What an agent senses: the vectors to ``entities``, the values of the signals ``variables``, and a map or none."""

    entities: tuple[str, ...]
    variables: tuple[str, ...]
    map: MapSensor | None


SensorChoice = Sensors | Mapping[str, Any]
"""A record, or a mapping with some of the fields of :class:`Sensors`; ``map`` may be a mapping, too."""
