"""Choose an agent's sensors: those that the level declares, or replacements for some or all."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from math import isfinite
from typing import Any, Final

from tltl_runtime.game.sensors import MapSensor, SensorChoice, Sensors
from tltl_runtime.stealth.level import StealthLevel, entity_names
from tltl_runtime.stealth.levels.level_tables import CELL_TYPES, CELL_WIDTH, MAP_EXTENT
from tltl_runtime.stealth.signals import readers, signal_list
from tltl_runtime.support.suggestion import suggestion
from tltlc.api import Diagnostic, TltlError

DEFAULT_MAP: Final = MapSensor(CELL_TYPES, 0.5, 15)
"""The default values of the map sensor, if the level itself has no map."""

_CELL: Final = f"give a width from {CELL_WIDTH[0]:g} to {CELL_WIDTH[1]:g} m"
_EXTENT: Final = f"give an odd number of cells from {MAP_EXTENT[0]} to {MAP_EXTENT[1]}, so that one is in the middle"


def choose_sensors(level: StealthLevel, choice: SensorChoice | None = None) -> Sensors:
    """Return the sensors that the agent uses: ``choice``, or the level's own if ``choice`` is None.

    ``choice`` is a record or a mapping. For the keys that a mapping leaves out, the level's own
    sensors are used. ``{"map": None}`` removes the map; ``{"map": {"cell": 1.0}}`` keeps the
    level's map but changes the width of its cells.

    Raises:
        TltlError: one TLT0815 for each mistake.
        TypeError: ``choice`` is neither a record nor a mapping.
    """
    if choice is None:
        return level.sensors
    if not isinstance(choice, (Sensors, Mapping)):
        raise TypeError(f"sensors must be a mapping, e.g. {{'entities': ['exit']}}, not {choice!r:.60}")
    log: list[Diagnostic] = []
    sensors = choice if isinstance(choice, Sensors) else _read(level, choice, log)
    _check(level, sensors, log)
    if log:
        raise TltlError(log)
    return sensors


def missing_sensors(level: StealthLevel, sensors: Sensors) -> Iterator[str]:
    """Yield a text for each entity or signal that ``sensors`` names and a level does not have.

    An example of such a text is "the entity `exit`".
    """
    entities, signals = entity_names(level), readers(level)
    yield from (f"the entity `{name}`" for name in sensors.entities if name not in entities)
    yield from (f"the signal `{name}`" for name in sensors.variables if name not in signals)


def _read(level: StealthLevel, choice: Mapping[str, Any], log: list[Diagnostic]) -> Sensors:
    """Return the sensors that the mapping ``choice`` describes, as a record.

    If a value has a wrong type, an error is logged, and the level's own value takes its place.
    """
    declared = level.sensors
    _check_names(map(str, choice), Sensors.__match_args__, "sensors have no key", log)
    map_ = declared.map
    if "map" in choice:
        value = choice["map"]
        if value is None or isinstance(value, MapSensor):
            map_ = value
        elif isinstance(value, Mapping):
            map_ = _read_map(declared.map or DEFAULT_MAP, value, log)
        else:
            log.append(_wrong_value("the map", value, "give its `cell`, `extent` and `types`, or None for no map"))
    return Sensors(
        _names(choice, "entities", declared.entities, log),
        _names(choice, "variables", declared.variables, log),
        map_,
    )


def _read_map(defaults: MapSensor, mapping: Mapping[str, Any], log: list[Diagnostic]) -> MapSensor:
    _check_names(map(str, mapping), MapSensor.__match_args__, "a map has no key", log)
    cell, extent = mapping.get("cell", defaults.cell), mapping.get("extent", defaults.extent)
    # Check the types first: `_check` compares the values as numbers.
    if not isinstance(cell, (int, float)) or isinstance(cell, bool):
        log.append(_wrong_value("`cell`", cell, _CELL))
        cell = defaults.cell
    if not isinstance(extent, int) or isinstance(extent, bool):
        log.append(_wrong_value("`extent`", extent, _EXTENT))
        extent = defaults.extent
    return MapSensor(_names(mapping, "types", defaults.types, log), float(cell), extent)


def _names(choice: Mapping[str, Any], key: str, default: tuple[str, ...], log: list[Diagnostic]) -> tuple[str, ...]:
    value = choice.get(key, default)
    if isinstance(value, str) or not isinstance(value, Iterable):
        log.append(_wrong_value(f"`{key}`", value, "give a list of names"))
        return default
    return tuple(map(str, value))


def _check(level: StealthLevel, sensors: Sensors, log: list[Diagnostic]) -> None:
    _check_names(sensors.entities, entity_names(level), f"the level `{level.name}` has no entity", log)
    _check_names(sensors.variables, readers(level), f"the level `{level.name}` has no signal", log, signal_list(level))
    if (map_ := sensors.map) is None:
        return
    _check_names(map_.types, CELL_TYPES, "a map has no type", log)
    if not (isfinite(map_.cell) and CELL_WIDTH[0] <= map_.cell <= CELL_WIDTH[1]):
        log.append(_wrong_value("`cell`", map_.cell, _CELL))
    if not MAP_EXTENT[0] <= map_.extent <= MAP_EXTENT[1] or map_.extent % 2 == 0:
        log.append(_wrong_value("`extent`", map_.extent, _EXTENT))


def _check_names(
    names: Iterable[str], known: Iterable[str], title: str, log: list[Diagnostic], listed: str | None = None
) -> None:
    names, known_names = tuple(names), tuple(known)
    twice = sorted({name for name in names if names.count(name) > 1})
    log += [Diagnostic("TLT0815", f"the sensors name `{name}` twice", help="name it once") for name in twice]
    log += [
        Diagnostic("TLT0815", f"{title} `{name}`", help=suggestion(name, known_names, listed))
        for name in dict.fromkeys(names)
        if name not in known_names
    ]


def _wrong_value(subject: str, value: object, expected: str) -> Diagnostic:
    return Diagnostic("TLT0815", f"wrong value for {subject} of the sensors: {value!r:.40}", help=expected)
