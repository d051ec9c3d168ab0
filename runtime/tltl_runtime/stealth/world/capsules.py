"""The player's body in the physics: a standing and a crouched capsule, one of which is active.

The inactive capsule touches nothing and falls. From time to time, :meth:`Capsules.park` moves it
back to its place below the level. Nothing simpler works: a sleeping Featherstone body also falls,
and a floor under the capsule would cost a quarter of the speed.
"""

from __future__ import annotations

from tltl_runtime.stealth.level import Point
from tltl_runtime.stealth.world.bodies import PARKED, PLAYER, RAY, UPRIGHT, WORLD, capsule, set_filter
from tltl_runtime.stealth.world.bullet import pybullet
from tltl_runtime.stealth.world.geometry import TOUCH
from tltl_runtime.stealth.world.player import PlayerKind

_STILL = (0.0, 0.0, 0.0)


class Capsules:
    """The player's two capsules, a standing and a crouched one, of which one is active.

    Both are created at ``parking``; the standing one is active at first. ``body`` is the Bullet id
    of the active capsule; ``height`` and ``radius`` are its size. Positions are those of the feet.
    """

    def __init__(self, client: int, kind: PlayerKind, parking: Point) -> None:
        self._client, self._parking = client, parking
        self.radius = kind.radius
        self._heights = (kind.height, kind.crouched_height)
        self._bodies = [capsule(client, kind.radius, height, parking) for height in self._heights]
        self._activate(False)

    def put(self, crouching: bool, feet: Point, velocity: Point) -> bool:
        """Move the player to ``feet``, standing or crouching, with this ``velocity``.

        Return whether this made the other capsule active.
        """
        changed = self.body != self._bodies[crouching]
        if changed:
            self._activate(crouching)
        place = (feet[0], feet[1], feet[2] + self.height / 2)
        pybullet.resetBasePositionAndOrientation(self.body, place, UPRIGHT, self._client)
        self.set_velocity(velocity)
        return changed

    def set_velocity(self, velocity: Point) -> None:
        """Set the player's velocity."""
        pybullet.resetBaseVelocity(self.body, velocity, _STILL, self._client)

    def feet(self) -> Point:
        """Return the position of the player's feet."""
        (x, y, z), _ = pybullet.getBasePositionAndOrientation(self.body, self._client)
        return x, y, z - self.height / 2

    def velocity(self) -> Point:
        """Return the player's velocity."""
        velocity: Point = pybullet.getBaseVelocity(self.body, self._client)[0]
        return velocity

    def is_grounded(self) -> bool:
        """Whether the player stands on something."""
        contacts = pybullet.getContactPoints(self.body, physicsClientId=self._client)
        return any(contact[7][2] > 0.5 and contact[8] < TOUCH for contact in contacts)

    def park(self) -> None:
        """Move the inactive capsule back below the level."""
        pybullet.resetBasePositionAndOrientation(self._parked, self._parking, UPRIGHT, self._client)
        pybullet.resetBaseVelocity(self._parked, _STILL, _STILL, self._client)

    def misfiltered_capsule(self) -> str | None:
        """Return the name of a capsule whose collision filter is wrong; None if both are right.

        A ray down through the active capsule must hit that capsule. A ray down through the inactive
        capsule must not hit it.
        """
        for name, body, height in zip(("standing", "crouched"), self._bodies, self._heights, strict=True):
            (x, y, z), _ = pybullet.getBasePositionAndOrientation(body, self._client)
            top = (x, y, z + height / 2 + 0.005)
            hit = pybullet.rayTest(top, (x, y, z), collisionFilterMask=PLAYER, physicsClientId=self._client)[0][0]
            if (hit == body) != (body == self.body):
                return name
        return None

    def _activate(self, crouching: bool) -> None:
        self.body, self._parked = self._bodies[crouching], self._bodies[not crouching]
        self.height = self._heights[crouching]
        set_filter(self._client, self._parked, PARKED, 0)
        set_filter(self._client, self.body, PLAYER, WORLD | RAY)
        self.park()
