"""Convert the tables of level files to the records of a level: one function per kind of thing."""

from __future__ import annotations

import math
from typing import Final, Literal, cast

from tltl_runtime.game.sensors import MapSensor, Sensors
from tltl_runtime.stealth.enemies.branches import added_branches
from tltl_runtime.stealth.level import (
    Barrier,
    Box,
    Enemy,
    EnemyKind,
    Exit,
    Mover,
    Point,
    Solid,
    Start,
    Switch,
    Unlock,
)
from tltl_runtime.support.checked_table import CheckedTable
from tltl_runtime.support.suggestion import suggestion
from tltlc.api import Diagnostic, Label, record

_OUTER_WALL: Final = 0.2
"""The thickness of the walls around a level, in metres."""

_MAX_RISE: Final = 0.25
"""The highest step of stairs that the player can walk up, in metres."""

CELL_TYPES: Final = ("floor", "platform", "low", "wall", "switch", "exit", "barrier", "laser", "mover", "enemy")
"""The types of the cells of a semantic map.

A cell that could have several types has the last of them in this order.
"""

_SOLIDS: Final[tuple[Literal["wall", "low", "platform"], ...]] = ("wall", "low", "platform")

CELL_WIDTH: Final = (0.1, 5.0)
"""The least and greatest width of a cell of the semantic map, in metres."""

MAP_EXTENT: Final = (3, 63)
"""The least and greatest number of cells along a side of the semantic map.

The number must be odd.
"""

_VARIABLES: Final = ("health", "stamina", "crouching", "grounded", "visible", "seen")
"""The signals that the agent observes if the level does not list any."""


@record
class NamedParts:
    """Remembers where the level's files name things, so that later checks can point there.

    A label is a place in a file. ``names`` maps the name of each thing to the label of this name,
    and ``positions`` maps it to the label of the thing's position.
    """

    names: dict[str, Label]
    positions: dict[str, Label]
    references: list[tuple[str, str, Label]]
    """Each reference: the kind of thing that it names, the name, and the reference's label."""

    def add(self, name: str, table: CheckedTable, position_key: str) -> None:
        """Record where a thing's name and position are; log TLT0804 if the name is taken.

        ``position_key`` is the key of ``table`` that has the position.
        """
        label = table.label_of("name")
        if name in self.names:
            title = f"two things are called `{name}`"
            table.log.append(Diagnostic("TLT0804", title, (label, self.names[name]), "give one of them another `name`"))
        self.names.setdefault(name, label)
        self.positions.setdefault(name, table.label_of(position_key))

    def name_labels(self, name: str) -> tuple[Label, ...]:
        """Return the label (the place in a file) of a thing's name; an empty tuple if no file contains the name."""
        return (self.names[name],) if name in self.names else ()

    def position_labels(self, *names: str) -> tuple[Label, ...]:
        """Return the labels (places in files) of the positions of the things with these names.

        Things without a place in a file, such as the outer walls, are left out.
        """
        return tuple(self.positions[name] for name in names if name in self.positions)

    def refer(self, kind: str, table: CheckedTable, key: str, names: tuple[str, ...]) -> None:
        """Record that the value of ``key`` in ``table`` is ``names``, which name things of this ``kind``.

        :func:`~tltl_runtime.stealth.levels.check.check_references` checks later that the things
        exist.
        """
        self.references.extend((kind, name, table.label_of(key)) for name in names)


def solids(table: CheckedTable, places: NamedParts, shift: Point = (0.0, 0.0, 0.0), prefix: str = "") -> list[Solid]:
    """Read the walls, low obstacles, platforms and stairs of a level or a part.

    A part is a group of solids and movers that levels share. ``shift`` is the position of a part in
    the level; ``prefix`` begins the names of the part's things. ``places`` records where the file
    names the solids.
    """
    solids = []
    for kind in _SOLIDS:
        for number, item in enumerate(table.tables(kind), 1):
            name = prefix + item.text("name", f"{kind}_{number}")
            solids.append(Solid(name, kind, box(item, shift)))
            places.add(name, item, "at")
            item.report_unknown_keys()
    for number, item in enumerate(table.tables("stairs"), 1):
        name = prefix + item.text("name", f"stairs_{number}")
        steps = _stairs(item, name, shift)
        solids += steps
        places.add(name, item, "from")
        places.positions.update({solid.name: item.label_of("from") for solid in steps})
        item.report_unknown_keys()
    return solids


def box(table: CheckedTable, shift: Point = (0.0, 0.0, 0.0)) -> Box:
    """Read a box from two keys of a table: ``at``, the middle of its base, and ``size``.

    ``shift`` is added to its position.
    """
    (x, y, z), (dx, dy, dz) = _shift(table.point("at"), shift), table.size()
    return Box(_round((x - dx / 2, y - dy / 2, z)), _round((x + dx / 2, y + dy / 2, z + dz)))


def _stairs(table: CheckedTable, name: str, shift: Point) -> list[Solid]:
    """Return one box for each step; each box reaches down to the height at which the stairs begin.

    If nobody can walk up the stairs, log TLT0803 and return an empty list.
    """
    foot, top = _shift(table.point("from"), shift), _shift(table.point("to"), shift)
    width = table.number("width", low=0.7, high=50.0)
    steps = table.whole("steps", low=1, high=40)
    rise = (top[2] - foot[2]) / steps
    run = [abs(top[0] - foot[0]), abs(top[1] - foot[1])]
    axis = 0 if run[0] >= run[1] else 1
    problem = None
    if min(run) > 1e-9 or run[axis] / steps < 0.2:
        problem = "along x or y, with steps at least 0.2 m deep"
    elif not 0.0 < rise <= _MAX_RISE + 1e-9:
        problem = f"that go upwards, with steps at most {_MAX_RISE} m high (here {rise:.3g} m)"
    if problem:
        label = table.label_of("to")
        table.log.append(Diagnostic("TLT0803", f"nobody can walk up `{name}`", (label,), f"expected stairs {problem}"))
        return []
    boxes = []
    for number in range(steps):
        begin, end = (foot[axis] + (top[axis] - foot[axis]) * (number + side) / steps for side in (0, 1))
        low, high = list(foot), list(foot)
        low[axis], high[axis] = min(begin, end), max(begin, end)
        low[1 - axis] -= width / 2
        high[1 - axis] += width / 2
        high[2] = foot[2] + rise * (number + 1)
        boxes.append(Solid(f"{name}_{number + 1}", "platform", Box(_round(low), _round(high))))
    return boxes


def movers(table: CheckedTable, places: NamedParts, shift: Point = (0.0, 0.0, 0.0), prefix: str = "") -> list[Mover]:
    """Read the movers (moving boxes) of a level or a part; ``shift`` and ``prefix`` are as in :func:`solids`.

    In files, the points of a path are for the middle of the mover's base, not for its centre.
    """
    movers = []
    for item in table.tables("mover"):
        name, size = prefix + item.text("name"), item.size()
        up = (shift[0], shift[1], shift[2] + size[2] / 2)
        path = tuple(_round(_shift(point, up)) for point in item.points("path", 2))
        speed = item.number("speed", low=0.01, high=10.0, unit="m/s")
        pause = item.number("pause", 0.0, low=0.0, high=600.0, unit="s")
        offset = item.number("offset", 0.0, low=0.0, high=600.0, unit="s")
        movers.append(Mover(name, size, path, speed, pause, offset, item.flag("closed")))
        places.add(name, item, "path")
        item.report_unknown_keys()
    return movers


def switches(table: CheckedTable, places: NamedParts) -> list[Switch]:
    """Read the switches of a level."""
    switches = []
    for item in table.tables("switch"):
        name = item.text("name")
        switches.append(Switch(name, item.point("at"), item.number("radius", 1.0, low=0.1, high=10.0)))
        places.add(name, item, "at")
        item.report_unknown_keys()
    return switches


def barriers(table: CheckedTable, places: NamedParts) -> list[Barrier]:
    """Read the barriers and lasers of a level."""
    barriers = []
    for kind, key in (("solid", "barrier"), ("laser", "laser")):
        for item in table.tables(key):
            name, opened_by = item.text("name"), item.names("opened_by", ())
            damage = item.number("damage", 0.5, low=0.0, high=100.0, unit="a second") if kind == "laser" else 0.0
            barriers.append(Barrier(name, cast(Literal["solid", "laser"], kind), box(item), opened_by, damage))
            places.add(name, item, "at")
            places.refer("switch", item, "opened_by", opened_by)
            item.report_unknown_keys({"damage": "[[laser]]"})
    return barriers


def unlocks(table: CheckedTable, places: NamedParts) -> list[Unlock]:
    """Read the unlocks of a level. An unlock is a switch that opens a random one of several barriers."""
    unlocks = []
    for item in table.tables("unlock"):
        unlock = Unlock(item.text("switch"), item.names("barriers"))
        if len(set(unlock.barriers)) < max(2, len(unlock.barriers)):
            help_ = "name two or more barriers, each of them only once"
            title = "an `[[unlock]]` needs several different barriers"
            item.log.append(Diagnostic("TLT0803", title, (item.label_of("barriers"),), help_))
        places.refer("switch", item, "switch", (unlock.switch,))
        places.refer("barrier", item, "barriers", unlock.barriers)
        item.report_unknown_keys()
        unlocks.append(unlock)
    return unlocks


def exits(table: CheckedTable, places: NamedParts) -> list[Exit]:
    """Read the exits of a level."""
    exits = []
    for item in table.tables("exit"):
        name = item.text("name")
        exits.append(Exit(name, item.point("at")))
        places.add(name, item, "at")
        item.report_unknown_keys()
    return exits


def enemies(table: CheckedTable, kinds: dict[str, EnemyKind], places: NamedParts) -> list[Enemy]:
    """Read the enemies of a level. ``kinds`` are the valid enemy kinds, by name.

    An enemy of another kind is left out.
    """
    enemies = []
    for item in table.tables("enemy"):
        name, kind, route = item.text("name"), item.text("kind"), item.points("route", 1)
        if kind in kinds:
            enemies.append(Enemy(name, kinds[kind], route))
        places.add(name, item, "route")
        item.report_unknown_keys()
    return enemies


def enemy_kind(table: CheckedTable, name: str) -> EnemyKind:
    """Read a kind of enemy from the asset ``name``, a file of type ``enemy``. In files, angles are in degrees."""
    kind = EnemyKind(
        name=name,
        sight_range=table.number("sight_range", low=0.0, high=100.0),
        sight_angle=math.radians(table.number("sight_angle", low=0.0, high=360.0, unit="degrees")),
        walk_speed=table.number("walk_speed", low=0.1, high=20.0, unit="m/s"),
        chase_speed=table.number("chase_speed", low=0.1, high=20.0, unit="m/s"),
        turn_speed=math.radians(table.number("turn_speed", low=1.0, high=3600.0, unit="degrees a second")),
        reaction_time=table.number("reaction_time", low=0.0, high=60.0, unit="s"),
        memory_time=table.number("memory_time", low=0.0, high=60.0, unit="s"),
        search_time=table.number("search_time", low=0.0, high=60.0, unit="s"),
        search_radius=table.number("search_radius", low=0.0, high=50.0),
        attack_range=table.number("attack_range", low=0.1, high=10.0),
        attack_damage=table.number("attack_damage", low=0.0, high=100.0, unit="a second"),
        branches=table.names("branches"),
    )
    for branch in kind.branches:
        if branch not in added_branches():
            title = f"there is no behaviour branch `{branch}`"
            help_ = suggestion(branch, added_branches())
            table.log.append(Diagnostic("TLT0805", title, (table.label_of("branches"),), help_))
    table.report_unknown_keys()
    return kind


def start(table: CheckedTable) -> Start:
    """Read the player's start. In files, its yaw is in degrees."""
    start = Start(
        table.point("at"),
        math.radians(table.number("yaw", 0.0, low=-360.0, high=360.0, unit="degrees")),
        table.number("spread", 0.0, low=0.0, high=10.0),
    )
    table.report_unknown_keys()
    return start


def sensors(table: CheckedTable | None, entities: tuple[str, ...], places: NamedParts) -> Sensors:
    """Read the agent's sensors.

    The defaults are all ``entities``, the signals in ``_VARIABLES``, and no map. If ``table`` is
    None, return the defaults.
    """
    if table is None:
        return Sensors(entities, _VARIABLES, None)
    map_sensor = None
    if (map_ := table.table("map", needed=False)) is not None:
        extent = map_.whole("extent", low=MAP_EXTENT[0], high=MAP_EXTENT[1])
        if extent % 2 == 0:
            help_ = "expected an odd number of cells, so that one is in the middle"
            title = f"wrong value for `extent`: {extent}"
            map_.log.append(Diagnostic("TLT0803", title, (map_.label_of("extent"),), help_))
        types = map_.names("types", CELL_TYPES)
        places.refer("cell type", map_, "types", types)
        map_sensor = MapSensor(types, map_.number("cell", low=CELL_WIDTH[0], high=CELL_WIDTH[1]), extent)
        map_.report_unknown_keys()
    sensors = Sensors(table.names("entities", entities), table.names("variables", _VARIABLES), map_sensor)
    places.refer("entity", table, "entities", sensors.entities)
    places.refer("signal", table, "variables", sensors.variables)
    table.report_unknown_keys()
    return sensors


def enclosure(bounds: Box) -> list[Solid]:
    """Return the floor, whose top is at height 0, and the walls around a level."""
    (x0, y0, z0), (x1, y1, z1) = bounds.low, bounds.high
    walls = {
        "outer_west": Box((x0, y0, 0.0), (x0 + _OUTER_WALL, y1, z1)),
        "outer_east": Box((x1 - _OUTER_WALL, y0, 0.0), (x1, y1, z1)),
        "outer_south": Box((x0, y0, 0.0), (x1, y0 + _OUTER_WALL, z1)),
        "outer_north": Box((x0, y1 - _OUTER_WALL, 0.0), (x1, y1, z1)),
    }
    return [
        Solid("floor", "floor", Box((x0, y0, z0), (x1, y1, 0.0))),
        *(Solid(name, "wall", wall) for name, wall in walls.items()),
    ]


def _shift(point: Point, shift: Point) -> Point:
    """Convert a point of a part to a point of the level; ``shift`` is the position of the part."""
    return (point[0] + shift[0], point[1] + shift[1], point[2] + shift[2])


def _round(point: list[float] | Point) -> Point:
    """Round coordinates to the micrometre, so that boxes that should touch do touch."""
    x, y, z = (round(value, 6) + 0.0 for value in point)
    return (x, y, z)
