"""Check that everything in a level is inside the bounds, and that nothing stands in a solid."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltl_runtime.stealth.enemies.grid import RADIUS
from tltl_runtime.stealth.level import Box, Level, Point
from tltl_runtime.stealth.levels.parts import Places
from tltl_runtime.stealth.world.geometry import around
from tltl_runtime.stealth.world.mover_path import MoverPath
from tltl_runtime.stealth.world.player import PlayerKind
from tltlc.api import Diagnostic, Label

_PLAYER: Final = PlayerKind()
_EPSILON: Final = 1e-6

_Boxes = list[tuple[str, Box]]


def check_room(level: Level, places: Places, start: Label) -> list[Diagnostic]:
    """Return TLT0806 for what is outside the bounds, TLT0807 for what stands inside an obstacle."""
    solids = [(solid.name, solid.box) for solid in level.solids]
    barriers = [(barrier.name, barrier.box) for barrier in level.barriers]
    goals = [(switch.name, switch.position) for switch in level.switches]
    goals += [(exit_.name, exit_.position) for exit_ in level.exits]
    return [
        *_outside(level, [*solids, *barriers], goals, places, start),
        *_start(level, [*solids, *barriers], places, start),
        *_goals(goals, solids, places),
        *_routes(level, solids, places),
    ]


def _outside(
    level: Level, boxes: _Boxes, goals: list[tuple[str, Point]], places: Places, start: Label
) -> Iterator[Diagnostic]:
    """Report what is outside the bounds, each thing once."""
    moving = [(mover.name, Box(*around(point, mover.size))) for mover in level.movers for point in mover.path]
    points = [*goals, *((enemy.name, point) for enemy in level.enemies for point in enemy.route)]
    spots = [(name, Box(point, point)) for name, point in points]
    bounds = f"the level from {shown(level.bounds.low)} to {shown(level.bounds.high)}"
    for name, box in {name: box for name, box in (*boxes, *moving, *spots) if not _inside(box, level.bounds)}.items():
        help_ = f"it reaches from {shown(box.low)} to {shown(box.high)}, {bounds}"
        yield Diagnostic("TLT0806", f"`{name}` is outside the level's bounds", places.at(name), help_)
    player = _player(level)
    if not _inside(player, level.bounds):
        help_ = f"the player takes from {shown(player.low)} to {shown(player.high)}, {bounds}"
        yield Diagnostic("TLT0806", "the start is outside the level's bounds", (start,), help_)


def _start(level: Level, boxes: _Boxes, places: Places, start: Label) -> Iterator[Diagnostic]:
    """Report what overlaps the player's start, including movers at their initial positions."""
    begins = [(mover.name, Box(*around(MoverPath(mover).at(mover.offset), mover.size))) for mover in level.movers]
    for name, box in (*boxes, *begins):
        if _overlap(_player(level), box):
            help_ = "move one of them, or lessen the start's `spread`: the player is 0.6 m wide and 1.8 m high"
            yield Diagnostic("TLT0807", f"the start is inside `{name}`", (start, *places.at(name)), help_)


def _goals(goals: list[tuple[str, Point]], solids: _Boxes, places: Places) -> Iterator[Diagnostic]:
    """Report the goals that are inside a solid, with the first such solid."""
    for goal, point in goals:
        if name := _first_around(_body(point, 0.01, 0.1), solids):
            title = f"`{goal}` is inside `{name}`, where nobody reaches it"
            yield Diagnostic("TLT0807", title, places.at(goal, name), "move one of them")


def _routes(level: Level, solids: _Boxes, places: Places) -> Iterator[Diagnostic]:
    """Report the points of routes that are blocked, with the first solid there."""
    for enemy in level.enemies:
        for point in enemy.route:
            if name := _first_around(_body(point, RADIUS), solids):
                title = f"`{enemy.name}` cannot walk to {shown(point)}: `{name}` is there"
                help_ = f"points of a route keep {RADIUS} m away from what stands in the level"
                yield Diagnostic("TLT0807", title, places.at(enemy.name, name), help_)


def _first_around(body: Box, solids: _Boxes) -> str | None:
    """The name of the first solid that overlaps a body, or None."""
    return next((name for name, box in solids if _overlap(body, box)), None)


def _player(level: Level) -> Box:
    """The space that the player may take at the start, including the spread."""
    return _body(level.start.position, _PLAYER.radius + level.start.spread)


def _body(feet: Point, radius: float, height: float = _PLAYER.height) -> Box:
    """The bounding box of a body, raised slightly, so that standing on something is no overlap."""
    x, y, z = feet
    return Box((x - radius, y - radius, z + 0.01), (x + radius, y + radius, z + height))


def _inside(box: Box, bounds: Box) -> bool:
    return all(
        bounds.low[axis] - _EPSILON <= box.low[axis] and box.high[axis] <= bounds.high[axis] + _EPSILON
        for axis in range(3)
    )


def _overlap(one: Box, other: Box) -> bool:
    return all(
        one.low[axis] < other.high[axis] - _EPSILON and other.low[axis] < one.high[axis] - _EPSILON for axis in range(3)
    )


def shown(point: Point) -> str:
    """Format a point as level files write it."""
    return f"[{', '.join(f'{value:g}' for value in point)}]"
