"""The data of a level: frozen records of what stands where.

Lengths are in metres, times in seconds, speeds in metres per second, angles in radians. x points
east, y north, z up. A yaw of 0 looks along x; the yaw grows towards y. Boxes are parallel to the
axes. No code depends on the name of a level.
"""

from __future__ import annotations

from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Literal

from tltl_runtime.game.geometry import Box as Box
from tltl_runtime.game.geometry import Point as Point
from tltl_runtime.game.geometry import Region as Region
from tltl_runtime.game.level import LevelSpec, parse_level_spec
from tltl_runtime.game.registry import STEALTH, game_named
from tltl_runtime.game.sensors import MapSensor as MapSensor
from tltl_runtime.game.sensors import Sensors as Sensors
from tltlc.api import record

if TYPE_CHECKING:
    from tltl_runtime.game.game import Game


@record
class Solid:
    """An object that stands still and blocks bodies.

    ``kind`` is its type on the agent's semantic map: a ``low`` obstacle hides a crouching body, a
    ``wall`` hides any body, and a ``platform`` is made to stand on. The kind does not change the
    physics: every solid stops bodies and sight within its box.
    """

    name: str
    kind: Literal["floor", "wall", "low", "platform"]
    box: Box


@record
class Switch:
    """A switch; it becomes active, for good, when the player comes within ``radius`` of it."""

    name: str
    position: Point
    radius: float


@record
class Barrier:
    """A barrier, which stays shut until all switches in ``opened_by`` are active.

    If ``opened_by`` is empty, an :class:`Unlock` opens the barrier. A shut barrier of the kind
    ``solid`` stops bodies and sight. A shut ``laser`` stops neither the player nor sight, but takes
    ``damage`` health per second from a player who touches it. Enemies do not walk into lasers.
    """

    name: str
    kind: Literal["solid", "laser"]
    box: Box
    opened_by: tuple[str, ...]
    damage: float = 0.0


@record
class Unlock:
    """A rule: when ``switch`` becomes active, one of ``barriers`` opens, chosen at random.

    All ``barriers`` are equally likely, and their ``opened_by`` is empty.
    """

    switch: str
    barriers: tuple[str, ...]


@record
class Mover:
    """A box of ``size`` whose centre moves along ``path``.

    It moves to the end of the path and back, or in a loop if ``closed``. It rests ``pause`` seconds
    at each point. An episode begins ``offset`` seconds into this cycle.
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
    """The parameters of a kind of enemy.

    A kind comes from a file that levels share: an edit changes all levels that use it. The
    behaviour trees of all kinds have the branches patrol, chase, search and return; ``branches``
    names further ones.
    """

    name: str
    sight_range: float
    sight_angle: float
    """The full opening angle of the cone of sight, in radians."""
    walk_speed: float
    chase_speed: float
    turn_speed: float
    reaction_time: float
    """Seconds that the player must be in sight before the chase begins."""
    memory_time: float
    """Seconds for which the enemy still knows the player's position after it has lost sight of the player."""
    search_time: float
    search_radius: float
    attack_range: float
    attack_damage: float
    """The health that an attack takes from the player per second."""
    branches: tuple[str, ...] = ()


@record
class Enemy:
    """An enemy, which walks its route in a loop."""

    name: str
    kind: EnemyKind
    route: tuple[Point, ...]


@record
class Exit:
    """An exit, which specs can ask the player to reach."""

    name: str
    position: Point


@record
class Start:
    """The player's start pose; ``position`` is at the feet.

    ``spread`` is the greatest distance by which an episode moves the start at random.
    """

    position: Point
    yaw: float = 0.0
    spread: float = 0.0


def _spec_text(spec: LevelSpec | None) -> str:
    return "" if spec is None else spec.text


@record
class StealthLevel:
    """One variant of a level.

    ``bounds`` enclose everything; the length of their diagonal is the parameter ``level_size`` of
    specs. ``files`` are the names of the files that the level was read from, each with its SHA-256,
    so that a report can show which of them changed.
    """

    json_texts = MappingProxyType({"spec": (_spec_text, parse_level_spec)})

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
    spec: LevelSpec | None
    """The spec that the level is made for; None if there is none."""
    files: tuple[tuple[str, str], ...]
    signals: tuple[tuple[str, str], ...] = ()
    """Pairs of an alias and its signal, such as (``open_right``, ``open(right)``).

    A spec may use either name.
    """
    regions: tuple[Region, ...] = ()
    """The regions that the level names, then one for each part.

    A part is a group of solids and movers from a file that levels share (``[[use]]``).
    """

    @property
    def game(self) -> Game[Any, Any]:
        """The stealth game."""
        return game_named(STEALTH)


def entity_names(level: StealthLevel) -> tuple[str, ...]:
    """Return the names of the switches, barriers, exits, enemies and movers, in this order."""
    return (
        *(switch.name for switch in level.switches),
        *(barrier.name for barrier in level.barriers),
        *(exit_.name for exit_ in level.exits),
        *(enemy.name for enemy in level.enemies),
        *(mover.name for mover in level.movers),
    )


def fixed_places(level: StealthLevel) -> dict[str, Point]:
    """Return the positions of the entities that never move: switches, exits and barriers, by name.

    The position of a barrier is the middle of its base.
    """
    places = {switch.name: switch.position for switch in level.switches}
    places |= {exit_.name: exit_.position for exit_ in level.exits}
    for barrier in level.barriers:
        low, high = barrier.box.low, barrier.box.high
        places[barrier.name] = ((low[0] + high[0]) / 2, (low[1] + high[1]) / 2, low[2])
    return places
