"""Check that everything in a level is inside the bounds, and that nothing stands in a solid."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltl_runtime.stealth.enemies.grid import RADIUS
from tltl_runtime.stealth.level import Box, Point, StealthLevel
from tltl_runtime.stealth.levels.level_tables import NamedParts
from tltl_runtime.stealth.world.geometry import box_around
from tltl_runtime.stealth.world.mover_path import MoverPath
from tltl_runtime.stealth.world.player import PlayerKind
from tltlc.api import Diagnostic, Label

_PLAYER: Final = PlayerKind()
_EPSILON: Final = 1e-6

_Boxes = list[tuple[str, Box]]


def check_room(level: StealthLevel, places: NamedParts, start: Label) -> list[Diagnostic]:
    """Return an error for each thing outside the bounds (TLT0806) or inside an obstacle (TLT0807).

    ``places`` and ``start`` say where the level's files describe the things and the player's start.
    The diagnostics point there.
    """
    solids = [(solid.name, solid.box) for solid in level.solids]
    barriers = [(barrier.name, barrier.box) for barrier in level.barriers]
    goals = [(switch.name, switch.position) for switch in level.switches]
    goals += [(exit_.name, exit_.position) for exit_ in level.exits]
    return [
        *_check_bounds(level, [*solids, *barriers], goals, places, start),
        *_check_start(level, [*solids, *barriers], places, start),
        *_check_goals(goals, solids, places),
        *_check_routes(level, solids, places),
    ]


def _check_bounds(
    level: StealthLevel, boxes: _Boxes, goals: list[tuple[str, Point]], places: NamedParts, start: Label
) -> Iterator[Diagnostic]:
    """Yield an error (TLT0806) for each thing that is outside the bounds."""
    moving = [(mover.name, Box(*box_around(point, mover.size))) for mover in level.movers for point in mover.path]
    points = [*goals, *((enemy.name, point) for enemy in level.enemies for point in enemy.route)]
    spots = [(name, Box(point, point)) for name, point in points]
    bounds = f"the level from {point_text(level.bounds.low)} to {point_text(level.bounds.high)}"
    for name, box in {
        name: box for name, box in (*boxes, *moving, *spots) if not _is_inside(box, level.bounds)
    }.items():
        help_ = f"it reaches from {point_text(box.low)} to {point_text(box.high)}, {bounds}"
        yield Diagnostic("TLT0806", f"`{name}` is outside the level's bounds", places.position_labels(name), help_)
    player = _player_box(level)
    if not _is_inside(player, level.bounds):
        help_ = f"the player reaches from {point_text(player.low)} to {point_text(player.high)}, {bounds}"
        yield Diagnostic("TLT0806", "the start is outside the level's bounds", (start,), help_)


def _check_start(level: StealthLevel, boxes: _Boxes, places: NamedParts, start: Label) -> Iterator[Diagnostic]:
    """Yield an error (TLT0807) for each thing that overlaps the player's start.

    Movers (moving boxes) count at their positions at the beginning of an episode.
    """
    begins = [
        (mover.name, Box(*box_around(MoverPath(mover).position_at(mover.offset), mover.size))) for mover in level.movers
    ]
    for name, box in (*boxes, *begins):
        if _overlaps(_player_box(level), box):
            help_ = "move one of them, or reduce the start's `spread`: the player is 0.6 m wide and 1.8 m high"
            yield Diagnostic("TLT0807", f"the start is inside `{name}`", (start, *places.position_labels(name)), help_)


def _check_goals(goals: list[tuple[str, Point]], solids: _Boxes, places: NamedParts) -> Iterator[Diagnostic]:
    """Yield an error (TLT0807) for each switch or exit that is inside a solid.

    If it is inside several solids, the error names only the first.
    """
    for goal, point in goals:
        if name := _first_overlap(_body_box(point, 0.01, 0.1), solids):
            title = f"`{goal}` is inside `{name}`, where no player can stand"
            yield Diagnostic("TLT0807", title, places.position_labels(goal, name), "move one of them")


def _check_routes(level: StealthLevel, solids: _Boxes, places: NamedParts) -> Iterator[Diagnostic]:
    """Yield an error (TLT0807) for each point of an enemy's route where a solid leaves the enemy no room."""
    for enemy in level.enemies:
        for point in enemy.route:
            if name := _first_overlap(_body_box(point, RADIUS), solids):
                title = f"`{enemy.name}` cannot walk to {point_text(point)}: `{name}` is there"
                help_ = f"keep the points of a route at least {RADIUS} m away from everything that stands in the level"
                yield Diagnostic("TLT0807", title, places.position_labels(enemy.name, name), help_)


def _first_overlap(body: Box, solids: _Boxes) -> str | None:
    """Return the name of the first solid that overlaps a body; None if no solid does."""
    return next((name for name, box in solids if _overlaps(body, box)), None)


def _player_box(level: StealthLevel) -> Box:
    """Return the box that encloses the player at all possible starts of an episode."""
    return _body_box(level.start.position, _PLAYER.radius + level.start.spread)


def _body_box(feet: Point, radius: float, height: float = _PLAYER.height) -> Box:
    """Return the bounding box of a body with this ``radius`` and ``height`` that stands at ``feet``.

    The box begins 1 cm above the feet, so that a body does not overlap the ground under it.
    """
    x, y, z = feet
    return Box((x - radius, y - radius, z + 0.01), (x + radius, y + radius, z + height))


def _is_inside(box: Box, bounds: Box) -> bool:
    return all(
        bounds.low[axis] - _EPSILON <= box.low[axis] and box.high[axis] <= bounds.high[axis] + _EPSILON
        for axis in range(3)
    )


def _overlaps(box: Box, other: Box) -> bool:
    return all(
        box.low[axis] < other.high[axis] - _EPSILON and other.low[axis] < box.high[axis] - _EPSILON for axis in range(3)
    )


def point_text(point: Point) -> str:
    """Return a point as level files write it, such as ``[1, 2.5, 0]``."""
    return f"[{', '.join(f'{value:g}' for value in point)}]"
