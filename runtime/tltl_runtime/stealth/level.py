"""A level as data: what stands where, frozen; the code knows no level by name.

Lengths are metres, times seconds, speeds metres a second, angles radians.  x points east, y north, z up;
a yaw of 0 looks along x and grows towards y.  Boxes are parallel to the axes.
"""

from __future__ import annotations

from typing import Literal

from tltlc.core.record import record

Point = tuple[float, float, float]


@record
class Box:
    """From ``low`` to ``high``, each side at least a centimetre long."""

    low: Point
    high: Point


@record
class Solid:
    """Something that stands still and lets nobody through.

    ``kind`` is how the agent senses it: a ``low`` obstacle hides who crouches behind it, a ``wall`` hides anybody,
    a ``platform`` is there to stand on.  Whatever its kind, it stops bodies and sight where its box is.
    """

    name: str
    kind: Literal["floor", "wall", "low", "platform"]
    box: Box


@record
class Switch:
    """Activated, for good, by a player who comes within ``radius`` of ``position``."""

    name: str
    position: Point
    radius: float


@record
class Barrier:
    """Shut until all switches in ``opened_by`` are active; ``solid`` ones stop bodies, a ``laser`` burns them.

    A laser stops no sight; it takes ``damage`` health a second from whom it touches.
    """

    name: str
    kind: Literal["solid", "laser"]
    box: Box
    opened_by: tuple[str, ...]
    damage: float = 0.0


@record
class Unlock:
    """When ``switch`` becomes active, one of ``barriers`` opens, each as likely as the others.

    These barriers have no switch of their own.
    """

    switch: str
    barriers: tuple[str, ...]


@record
class Mover:
    """A box of ``size`` whose centre goes along ``path`` and back, or round and round where it is ``closed``.

    It starts ``offset`` seconds into its way and rests ``pause`` seconds at each point.
    """

    name: str
    size: Point
    path: tuple[Point, ...]
    speed: float
    pause: float = 0.0
    offset: float = 0.0
    closed: bool = False


@record
class EnemyKind:
    """The numbers of an enemy, a shared asset: one edit changes all levels that use it.

    ``branches`` names what its behaviour tree has beside patrol, chase, search and return.
    """

    name: str
    sight_range: float
    sight_angle: float
    """Full angle of the cone of sight."""
    walk_speed: float
    chase_speed: float
    turn_speed: float
    reaction_time: float
    """How long the player must be in sight before the chase begins."""
    memory_time: float
    """How long the enemy still knows where the player is, once out of sight."""
    search_time: float
    search_radius: float
    attack_range: float
    attack_damage: float
    """Health a second."""
    branches: tuple[str, ...] = ()


@record
class Enemy:
    """An enemy on its route, which it walks round and round."""

    name: str
    kind: EnemyKind
    route: tuple[Point, ...]


@record
class Exit:
    """Where the level ends."""

    name: str
    position: Point


@record
class Region:
    """A part of a level that reports call by its name."""

    name: str
    box: Box


@record
class Start:
    """Where the player begins, on its feet; ``spread`` is the greatest distance by which an episode moves it."""

    position: Point
    yaw: float = 0.0
    spread: float = 0.0


@record
class MapSensor:
    """The semantic map: ``extent`` cells (odd) to a side around the agent, each ``cell`` metres wide."""

    types: tuple[str, ...]
    cell: float
    extent: int


@record
class Sensors:
    """What the agent senses: vectors to ``entities``, values of ``variables`` (signals), and the map."""

    entities: tuple[str, ...]
    variables: tuple[str, ...]
    map: MapSensor | None


@record
class Level:
    """A level in one of its variants.

    ``bounds`` hold everything; its diagonal is the param ``level_size`` of specs.  ``files`` are those it was made
    of, with their SHA-256, so that a report can say what changed.
    """

    name: str
    variant: str
    doc: str
    bounds: Box
    start: Start
    solids: tuple[Solid, ...]
    switches: tuple[Switch, ...]
    barriers: tuple[Barrier, ...]
    unlocks: tuple[Unlock, ...]
    movers: tuple[Mover, ...]
    enemies: tuple[Enemy, ...]
    exits: tuple[Exit, ...]
    sensors: Sensors
    spec: str
    """The file of the spec that the level is made for, and what it is called there: ``FILE.tltl:NAME``."""
    files: tuple[tuple[str, str], ...]
    signals: tuple[tuple[str, str], ...] = ()
    """Further names of signals, for specs that call them otherwise: (``open_right``, ``open(right)``)."""
    regions: tuple[Region, ...] = ()
    """Those that the level names, then the parts that it uses."""


def entity_names(level: Level) -> tuple[str, ...]:
    """What specs may speak of by name: switches, barriers, exits, enemies and movers, in this order."""
    return (
        *(switch.name for switch in level.switches),
        *(barrier.name for barrier in level.barriers),
        *(way_out.name for way_out in level.exits),
        *(enemy.name for enemy in level.enemies),
        *(mover.name for mover in level.movers),
    )


def fixed_places(level: Level) -> dict[str, Point]:
    """Where each entity is that stays there, by name; of a barrier it is the middle of the base."""
    places = {switch.name: switch.position for switch in level.switches}
    places |= {way_out.name: way_out.position for way_out in level.exits}
    for barrier in level.barriers:
        low, high = barrier.box.low, barrier.box.high
        places[barrier.name] = ((low[0] + high[0]) / 2, (low[1] + high[1]) / 2, low[2])
    return places
