"""What the agent senses, chosen anew beside what its level declares: by a record, a plain mapping, or in part."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from math import isfinite
from typing import Any, Final

from tltl_runtime.stealth.level import Level, MapSensor, Sensors, entity_names
from tltl_runtime.stealth.levels.parts import CELL_TYPES, CELL_WIDTH, MAP_EXTENT
from tltl_runtime.stealth.levels.table import suggestion
from tltl_runtime.stealth.signals import described, readers
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError

SensorChoice = Sensors | Mapping[str, Any]
"""A record, or a mapping with some of its fields: ``entities``, ``variables`` and ``map``, the latter a mapping too."""

DEFAULT_MAP: Final = MapSensor(CELL_TYPES, 0.5, 15)
"""What is not said of the map of a level that has none."""

_CELL: Final = f"give a width from {CELL_WIDTH[0]:g} to {CELL_WIDTH[1]:g} m"
_EXTENT: Final = f"give an odd number of cells from {MAP_EXTENT[0]} to {MAP_EXTENT[1]}, so that one is in the middle"


def chosen(level: Level, choice: SensorChoice | None = None) -> Sensors:
    """The sensors of a level with what ``choice`` says in place of its own; without one, its own.

    A mapping may leave out what stays as it is, ``{"map": None}`` is no map, and ``{"map": {"cell": 1.0}}`` the
    level's own map with other cells.  Raises TltlError, with one TLT0815 for each thing that is wrong; TypeError,
    where ``choice`` is neither.
    """
    if choice is None:
        return level.sensors
    if not isinstance(choice, (Sensors, Mapping)):
        raise TypeError(f"sensors are a mapping, e.g. {{'entities': ['exit']}}, not {choice!r:.60}")
    log: list[Diagnostic] = []
    sensors = choice if isinstance(choice, Sensors) else _read(level, choice, log)
    _check(level, sensors, log)
    if log:
        raise TltlError(log)
    return sensors


def _read(level: Level, choice: Mapping[str, Any], log: list[Diagnostic]) -> Sensors:
    """The record that a mapping stands for; stand-ins for what is of another kind."""
    own = level.sensors
    _check_names(map(str, choice), Sensors.__match_args__, "sensors have no key", log)
    map_ = own.map
    if "map" in choice:
        given = choice["map"]
        if given is None or isinstance(given, MapSensor):
            map_ = given
        elif isinstance(given, Mapping):
            map_ = _read_map(own.map or DEFAULT_MAP, given, log)
        else:
            log.append(_wrong("the map", given, "give its `cell`, `extent` and `types`, or None for no map"))
    return Sensors(
        _names(choice, "entities", own.entities, log),
        _names(choice, "variables", own.variables, log),
        map_,
    )


def _read_map(own: MapSensor, given: Mapping[str, Any], log: list[Diagnostic]) -> MapSensor:
    _check_names(map(str, given), MapSensor.__match_args__, "a map has no key", log)
    cell, extent = given.get("cell", own.cell), given.get("extent", own.extent)
    # Of what is no number, `_check` would have nothing to say but that it cannot be compared.
    if not isinstance(cell, (int, float)) or isinstance(cell, bool):
        log.append(_wrong("`cell`", cell, _CELL))
        cell = own.cell
    if not isinstance(extent, int) or isinstance(extent, bool):
        log.append(_wrong("`extent`", extent, _EXTENT))
        extent = own.extent
    return MapSensor(_names(given, "types", own.types, log), float(cell), extent)


def _names(choice: Mapping[str, Any], key: str, own: tuple[str, ...], log: list[Diagnostic]) -> tuple[str, ...]:
    given = choice.get(key, own)
    if isinstance(given, str) or not isinstance(given, Iterable):
        log.append(_wrong(f"`{key}`", given, "give a list of names"))
        return own
    return tuple(map(str, given))


def _check(level: Level, sensors: Sensors, log: list[Diagnostic]) -> None:
    _check_names(sensors.entities, entity_names(level), f"the level `{level.name}` has no entity", log)
    _check_names(sensors.variables, readers(level), f"the level `{level.name}` has no signal", log, described(level))
    if (map_ := sensors.map) is None:
        return
    _check_names(map_.types, CELL_TYPES, "a map knows no type", log)
    if not (isfinite(map_.cell) and CELL_WIDTH[0] <= map_.cell <= CELL_WIDTH[1]):
        log.append(_wrong("`cell`", map_.cell, _CELL))
    if not MAP_EXTENT[0] <= map_.extent <= MAP_EXTENT[1] or map_.extent % 2 == 0:
        log.append(_wrong("`extent`", map_.extent, _EXTENT))


def _check_names(
    names: Iterable[str], known: Iterable[str], title: str, log: list[Diagnostic], listed: str | None = None
) -> None:
    names, there = tuple(names), tuple(known)
    twice = sorted({name for name in names if names.count(name) > 1})
    log += [Diagnostic("TLT0815", f"`{name}` is to be sensed twice", help="name it once") for name in twice]
    log += [
        Diagnostic("TLT0815", f"{title} `{name}`", help=suggestion(name, there, listed))
        for name in dict.fromkeys(names)
        if name not in there
    ]


def _wrong(what: str, value: object, expected: str) -> Diagnostic:
    return Diagnostic("TLT0815", f"wrong value for {what} of what is sensed: {value!r:.40}", help=expected)
