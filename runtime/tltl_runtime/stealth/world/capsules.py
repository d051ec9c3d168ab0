"""The player's body in the physics: a standing and a crouched capsule, of which one is played.

The other touches nothing, falls, and is now and then put back under the level: a Featherstone body that is put to sleep
falls all the same, and one that rests on a floor costs a quarter of the speed.
"""

from __future__ import annotations

from tltl_runtime.stealth.level import Point
from tltl_runtime.stealth.world.bodies import PARKED, PLAYER, RAY, UPRIGHT, WORLD, capsule, set_filter
from tltl_runtime.stealth.world.bullet import pybullet
from tltl_runtime.stealth.world.geometry import TOUCH
from tltl_runtime.stealth.world.player import PlayerKind

_STILL = (0.0, 0.0, 0.0)


class Capsules:
    """The two capsules, made at ``parking``, with the standing one played: ``body`` is its number in Bullet.

    ``height`` and ``radius`` are those of the capsule that is played, positions those of its feet.
    """

    def __init__(self, client: int, kind: PlayerKind, parking: Point) -> None:
        self._client, self._parking = client, parking
        self.radius = kind.radius
        self._heights = (kind.height, kind.crouched_height)
        self._bodies = [capsule(client, kind.radius, height, parking) for height in self._heights]
        self._play(False)

    def put(self, crouching: bool, feet: Point, velocity: Point) -> bool:
        """Put the player there, standing or crouched; tells whether that is another capsule than before."""
        changed = self.body != self._bodies[crouching]
        if changed:
            self._play(crouching)
        place = (feet[0], feet[1], feet[2] + self.height / 2)
        pybullet.resetBasePositionAndOrientation(self.body, place, UPRIGHT, self._client)
        self.speed(velocity)
        return changed

    def speed(self, velocity: Point) -> None:
        """Give the player a velocity."""
        pybullet.resetBaseVelocity(self.body, velocity, _STILL, self._client)

    def feet(self) -> Point:
        """Where the feet are."""
        (x, y, z), _ = pybullet.getBasePositionAndOrientation(self.body, self._client)
        return x, y, z - self.height / 2

    def velocity(self) -> Point:
        """How fast the player goes."""
        velocity: Point = pybullet.getBaseVelocity(self.body, self._client)[0]
        return velocity

    def grounded(self) -> bool:
        """Whether the player stands on something."""
        contacts = pybullet.getContactPoints(self.body, physicsClientId=self._client)
        return any(contact[7][2] > 0.5 and contact[8] < TOUCH for contact in contacts)

    def park(self) -> None:
        """Put the capsule that is not played back under the level."""
        pybullet.resetBasePositionAndOrientation(self._parked, self._parking, UPRIGHT, self._client)
        pybullet.resetBaseVelocity(self._parked, _STILL, _STILL, self._client)

    def misfiltered(self) -> str | None:
        """The capsule whose filter is not the one that was set, if any.

        A ray down the played capsule hits it, and one down the parked capsule does not, each in its own group.
        """
        for name, body, height in zip(("standing", "crouched"), self._bodies, self._heights, strict=True):
            (x, y, z), _ = pybullet.getBasePositionAndOrientation(body, self._client)
            top = (x, y, z + height / 2 + 0.005)
            hit = pybullet.rayTest(top, (x, y, z), collisionFilterMask=PLAYER, physicsClientId=self._client)[0][0]
            if (hit == body) != (body == self.body):
                return name
        return None

    def _play(self, crouching: bool) -> None:
        self.body, self._parked = self._bodies[crouching], self._bodies[not crouching]
        self.height = self._heights[crouching]
        set_filter(self._client, self._parked, PARKED, 0)
        set_filter(self._client, self.body, PLAYER, WORLD | RAY)
        self.park()
