"""The moving obstacles of a level: they go their ways, and push the player.

Bullet sees a box that is put elsewhere, not one that moves, so a push is given to the player as velocity.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import sqrt

from tltl_runtime.stealth.level import Mover, Point
from tltl_runtime.stealth.world.bodies import UPRIGHT, static_box
from tltl_runtime.stealth.world.bullet import pybullet
from tltl_runtime.stealth.world.capsules import Capsules
from tltl_runtime.stealth.world.geometry import around, contact
from tltl_runtime.stealth.world.player import DECISION
from tltl_runtime.stealth.world.way import Way

_REACH = 1.5
"""How near the player is, on its way of a decision, to what it may meet."""
_HARDEST_PUSH = 8.0
"""Greatest speed that a mover gives the player."""


class Moving:
    """One mover, made at its offset: ``place`` is its centre now, ``box`` its corners."""

    def __init__(self, client: int, mover: Mover) -> None:
        self._client = client
        self._way = Way(mover)
        self._size = mover.size
        self.clock = mover.offset
        self.place = self._way.at(self.clock)
        self.box = around(self.place, mover.size)
        self._body = static_box(client, mover.size, self.place)
        width, depth, rise = mover.size
        reach = _REACH + mover.speed * DECISION
        self._reach = (width / 2 + reach, depth / 2 + reach, rise / 2 + reach)

    def put(self, clock: float) -> None:
        """Be where it is at a time of its own clock."""
        self.clock = clock
        place = self._way.at(clock)
        if place != self.place:
            self.place = place
            self.box = around(place, self._size)
            pybullet.resetBasePositionAndOrientation(self._body, place, UPRIGHT, self._client)

    def is_near(self, feet: Point, height: float) -> bool:
        """Whether a player of this height may meet it in the next decision."""
        (x, y, z), (a, b, c), (along, across, up) = feet, self.place, self._reach
        return abs(x - a) <= along and abs(y - b) <= across and c - up - height <= z <= c + up


def push(
    movers: Sequence[Moving], seconds: float, player: Capsules, room: Callable[[Point, float, Moving], bool]
) -> None:
    """Let each mover go on, and push the player; to be followed by the physics step of these ``seconds``.

    A mover waits where the player has no ``room`` to be pushed to, itself left out: a box that went on regardless would
    press the player through a wall, however slowly.
    """
    x, y, z = feet = player.feet()
    height, radius = player.height, player.radius
    for mover in movers:
        clock, old = mover.clock, mover.box
        mover.put(clock + seconds)
        deep, normal = contact(feet, height, radius, *mover.box)
        if deep <= 0.0 or deep <= contact(feet, height, radius, *old)[0]:
            continue
        across = sqrt(normal[0] ** 2 + normal[1] ** 2)
        if normal[2] < 0.0 and across > 0.3:
            # An edge that comes down on the shoulder pushes aside.
            deep, normal = deep / across, (normal[0] / across, normal[1] / across, 0.0)
        if not room((x + deep * normal[0], y + deep * normal[1], z + deep * normal[2]), height, mover):
            mover.put(clock)
            continue
        vx, vy, vz = player.velocity()
        lack = min(deep / seconds, _HARDEST_PUSH) - (vx * normal[0] + vy * normal[1] + vz * normal[2])
        if lack > 0.0:
            player.speed((vx + lack * normal[0], vy + lack * normal[1], vz + lack * normal[2]))
