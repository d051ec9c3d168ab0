"""Compute how far to lift the player, so that the player walks up stairs.

The physics engine, Bullet, does not lift the player: the velocity, which is set once per time step,
is horizontal, so the player would stop at the edge of a high stair.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from tltl_runtime.stealth.level import Point
from tltl_runtime.stealth.world.geometry import TOUCH, Bounds, depth
from tltl_runtime.stealth.world.player import DECISION, PlayerKind

HasRoom = Callable[[Point, float], bool]
"""A function of a point and a height: whether a player of this height has room at the point."""


def lift(
    kind: PlayerKind,
    feet: Point,
    height: float,
    velocity: tuple[float, float],
    boxes: Sequence[Bounds],
    has_room: HasRoom,
) -> float:
    """Return how far to lift the player's feet, in metres, so that the player walks up a stair.

    The result is 0 if there is no stair in the way of the next time step. ``boxes`` are the boxes
    that the player could touch. ``has_room`` says whether a player has room at a point.
    """
    x, y, z = feet
    highest = z + kind.step_height + 2 * TOUCH
    if velocity == (0.0, 0.0) or not any(z + TOUCH < high[2] <= highest for _, high in boxes):
        return 0.0
    ahead = (x + velocity[0] * DECISION, y + velocity[1] * DECISION)
    west, east = min(x, ahead[0]) - kind.radius, max(x, ahead[0]) + kind.radius
    south, north = min(y, ahead[1]) - kind.radius, max(y, ahead[1]) + kind.radius
    met = [
        (low, high)
        for low, high in boxes
        if low[2] < z + kind.radius
        and z + TOUCH < high[2]
        and low[0] < east
        and west < high[0]
        and low[1] < north
        and south < high[1]
    ]
    if not met:
        return 0.0
    # A wall beside the stairs must not stop a diagonal walk up along it: try each axis alone as well.
    both = velocity[0] and velocity[1]
    directions = (velocity, (velocity[0], 0.0), (0.0, velocity[1])) if both else (velocity,)
    return max(_lift_along(kind, feet, height, direction, met, has_room) for direction in directions)


def _lift_along(
    kind: PlayerKind,
    feet: Point,
    height: float,
    velocity: tuple[float, float],
    boxes: Sequence[Bounds],
    has_room: HasRoom,
) -> float:
    """Return how far to lift the feet onto the first box that the player meets, in metres.

    The player moves along ``velocity``. The result is 0 if the box is too high, or if there is no
    room above it.
    """
    x, y, z = feet
    for share in (1 / 3, 2 / 3, 1.0):
        ahead = (x + velocity[0] * DECISION * share, y + velocity[1] * DECISION * share)
        tops = [high[2] for low, high in boxes if depth((*ahead, z), height, kind.radius, low, high) > TOUCH]
        if tops:
            step = max(tops) - z + 0.005
            fits = step <= kind.step_height + TOUCH and all(
                has_room((a, b, z + step), height) for a, b in ((x, y), ahead)
            )
            return step if fits else 0.0
    return 0.0
