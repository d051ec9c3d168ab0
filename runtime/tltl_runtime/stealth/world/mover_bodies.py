"""The bodies of the movers (moving boxes) of a level: they follow their paths and push the player.

For Bullet, a mover is a box that is teleported, so it pushes nothing. This module pushes the player
by setting the player's velocity.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import sqrt

from tltl_runtime.stealth.level import Mover, Point
from tltl_runtime.stealth.world.bodies import UPRIGHT, static_box
from tltl_runtime.stealth.world.bullet import pybullet
from tltl_runtime.stealth.world.capsules import Capsules
from tltl_runtime.stealth.world.geometry import box_around, contact
from tltl_runtime.stealth.world.mover_path import MoverPath
from tltl_runtime.stealth.world.player import DECISION

_REACH = 1.5
"""The player can touch a mover within a time step from at most this far away, in metres.

This is for a mover at rest. The distance that a mover moves in the time step comes on top.
"""
_HARDEST_PUSH = 8.0
"""The greatest speed that a mover gives to the player, in metres per second."""


class MoverBody:
    """The body of a mover in the physics; ``place`` is its current centre, ``box`` has its corners.

    At first, the body is where the mover is ``offset`` seconds after the start of its cycle.
    """

    def __init__(self, client: int, mover: Mover) -> None:
        self._client = client
        self._path = MoverPath(mover)
        self._size = mover.size
        self.clock = mover.offset
        self.place = self._path.position_at(self.clock)
        self.box = box_around(self.place, mover.size)
        self._body = static_box(client, mover.size, self.place)
        width, depth, rise = mover.size
        reach = _REACH + mover.speed * DECISION
        self._reach = (width / 2 + reach, depth / 2 + reach, rise / 2 + reach)

    def put(self, clock: float) -> None:
        """Move the body to where the mover is ``clock`` seconds after the start of its cycle."""
        self.clock = clock
        place = self._path.position_at(clock)
        if place != self.place:
            self.place = place
            self.box = box_around(place, self._size)
            pybullet.resetBasePositionAndOrientation(self._body, place, UPRIGHT, self._client)

    def is_near(self, feet: Point, height: float) -> bool:
        """Whether a player at ``feet`` can touch the mover within the next time step."""
        (x, y, z), (a, b, c), (along, across, up) = feet, self.place, self._reach
        return abs(x - a) <= along and abs(y - b) <= across and c - up - height <= z <= c + up


def push(
    movers: Sequence[MoverBody], seconds: float, player: Capsules, has_room: Callable[[Point, float, MoverBody], bool]
) -> None:
    """Advance the movers and push the player; call this before each physics step of ``seconds``.

    ``has_room(feet, height, mover)`` says whether a capsule is free of everything but the mover. If
    the push would leave the player no room, the mover waits: otherwise it would press the player
    through a wall.
    """
    x, y, z = feet = player.feet()
    height, radius = player.height, player.radius
    for mover in movers:
        clock, old = mover.clock, mover.box
        mover.put(clock + seconds)
        overlap, normal = contact(feet, height, radius, *mover.box)
        if overlap <= 0.0 or overlap <= contact(feet, height, radius, *old)[0]:
            continue
        across = sqrt(normal[0] ** 2 + normal[1] ** 2)
        if normal[2] < 0.0 and across > 0.3:
            # An edge that comes down on the player's shoulder pushes sideways.
            overlap, normal = overlap / across, (normal[0] / across, normal[1] / across, 0.0)
        if not has_room((x + overlap * normal[0], y + overlap * normal[1], z + overlap * normal[2]), height, mover):
            mover.put(clock)
            continue
        vx, vy, vz = player.velocity()
        missing_speed = min(overlap / seconds, _HARDEST_PUSH) - (vx * normal[0] + vy * normal[1] + vz * normal[2])
        if missing_speed > 0.0:
            player.set_velocity(
                (vx + missing_speed * normal[0], vy + missing_speed * normal[1], vz + missing_speed * normal[2])
            )
