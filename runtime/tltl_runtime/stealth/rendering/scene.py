"""The bodies in pictures: a pybullet client without physics, which shows snapshots.

Bodies have no collision shapes here, and each box is a body. To hide a body, the scene moves it far
below the level. TinyRenderer cannot draw translucent objects, such as lasers. So they are not
bodies, and :mod:`tltl_runtime.stealth.rendering.paint` draws them.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from functools import lru_cache
from itertools import pairwise
from math import cos, pi, sin
from typing import Final

import numpy as np

from tltl_runtime.stealth.enemies.grid import RADIUS
from tltl_runtime.stealth.level import Box, Point, StealthLevel
from tltl_runtime.stealth.snapshot import Snapshot
from tltl_runtime.stealth.world.bodies import UPRIGHT
from tltl_runtime.stealth.world.bullet import pybullet
from tltl_runtime.stealth.world.geometry import box_around
from tltl_runtime.stealth.world.player import PlayerKind
from tltlc.api import record

Colour = tuple[float, float, float]
"""Red, green and blue, in [0, 1]."""

SOLIDS: Final[dict[str, Colour]] = {
    "floor": (0.80, 0.83, 0.87),
    "platform": (0.55, 0.66, 0.78),
    "low": (0.76, 0.60, 0.42),
    "wall": (0.52, 0.56, 0.64),
}
BARRIER: Final[Colour] = (0.90, 0.55, 0.13)
MOVER: Final[Colour] = (0.55, 0.36, 0.85)
SHUT_SWITCH: Final[Colour] = (0.98, 0.78, 0.12)
ACTIVE_SWITCH: Final[Colour] = (0.16, 0.75, 0.38)
EXIT: Final[Colour] = (0.10, 0.70, 0.48)
PLAYER: Final[Colour] = (0.16, 0.42, 0.95)
ENEMY: Final[Colour] = (0.85, 0.18, 0.18)
VISOR: Final[Colour] = (0.08, 0.09, 0.13)

_ENEMY_HEIGHT: Final = 1.8
_AWAY: Final = (0.0, 0.0, -1000.0)


@record
class Obstacle:
    """A box in a scene that may hide what is behind it; ``body`` is its id in pybullet."""

    body: int
    box: Box
    colour: Colour
    moves: bool = False


class Scene:
    """The bodies of a level in a pybullet client of their own.

    ``pose`` moves them to match a snapshot.
    """

    def __init__(self, level: StealthLevel) -> None:
        self.level = level
        self.client = pybullet.connect(pybullet.DIRECT)
        self.floors = [self._box(solid.box, SOLIDS["floor"]) for solid in level.solids if solid.kind == "floor"]
        self._solids = [
            self._obstacle(solid.box, SOLIDS[solid.kind]) for solid in level.solids if solid.kind != "floor"
        ]
        self._barriers = [self._obstacle(barrier.box, BARRIER) for barrier in level.barriers if barrier.kind == "solid"]
        self._movers = [self._obstacle(Box(*box_around(mover.path[0], mover.size)), MOVER) for mover in level.movers]
        self._away: set[int] = set()
        self._switches = [self._switch(switch.position, switch.radius) for switch in level.switches]
        self._active = [False] * len(level.switches)
        for exit_ in level.exits:
            self._beacon(exit_.position)
        self._enemies = [self._person(RADIUS, _ENEMY_HEIGHT, ENEMY) for _ in level.enemies]
        kind = PlayerKind()
        self._standing = self._person(kind.radius, kind.height, PLAYER)
        self._crouched = self._person(kind.radius, kind.crouched_height, PLAYER)

    def close(self) -> None:
        """Disconnect the client; closing twice does nothing."""
        if self.client >= 0:
            pybullet.disconnect(physicsClientId=self.client)
            self.client = -1

    def obstacles(self, snapshot: Snapshot) -> list[Obstacle]:
        """Return the boxes in a snapshot: solids except floors, shut solid barriers, and movers."""
        solid = [
            is_open
            for barrier, is_open in zip(self.level.barriers, snapshot.open, strict=True)
            if barrier.kind == "solid"
        ]
        shut = [barrier for barrier, is_open in zip(self._barriers, solid, strict=True) if not is_open]
        movers = [
            Obstacle(obstacle.body, Box(*box_around(place, mover.size)), obstacle.colour, moves=True)
            for obstacle, mover, place in zip(self._movers, self.level.movers, snapshot.movers, strict=True)
        ]
        return [*self._solids, *shut, *movers]

    def pose(self, snapshot: Snapshot, visible: Collection[Obstacle]) -> None:
        """Move all bodies to match a snapshot, and hide the obstacles that are not ``visible``."""
        visible_bodies = {obstacle.body for obstacle in visible}
        for obstacle in visible:
            if obstacle.moves or obstacle.body in self._away:
                self._put(obstacle.body, _middle(obstacle.box), 0.0)
                self._away.discard(obstacle.body)
        for obstacle in (*self._solids, *self._barriers, *self._movers):
            if obstacle.body not in visible_bodies | self._away:
                self._put(obstacle.body, _AWAY, 0.0)
                self._away.add(obstacle.body)
        for person, place, yaw in zip(self._enemies, snapshot.enemies, snapshot.yaws, strict=True):
            self._stand(person, place, yaw)
        player = snapshot.player
        body, hidden = (self._standing, self._crouched)[:: -1 if player.crouching else 1]
        self._stand(body, player.position, player.yaw)
        self._stand(hidden, _AWAY, 0.0)
        for index, active in enumerate(snapshot.active):
            if active != self._active[index]:
                self._active[index] = active
                self._colour(self._switches[index], ACTIVE_SWITCH if active else SHUT_SWITCH)

    def _obstacle(self, box: Box, colour: Colour) -> Obstacle:
        return Obstacle(self._box(box, colour), box, colour)

    def _box(self, box: Box, colour: Colour) -> int:
        half = [(b - a) / 2 for a, b in zip(box.low, box.high, strict=True)]
        shape = pybullet.createVisualShape(
            pybullet.GEOM_BOX, halfExtents=half, rgbaColor=(*colour, 1.0), physicsClientId=self.client
        )
        return self._body(shape, _middle(box))

    def _lathe(self, profile: Sequence[tuple[float, float]], colour: Colour, place: Point = _AWAY) -> int:
        """Create a body of revolution about the z axis; return its id.

        ``profile`` has pairs (radius, z), from bottom to top.
        """
        vertices, normals, indices = _revolve(tuple(profile))
        shape = pybullet.createVisualShape(
            pybullet.GEOM_MESH,
            vertices=vertices,
            normals=normals,
            indices=indices,
            rgbaColor=(*colour, 1.0),
            physicsClientId=self.client,
        )
        return self._body(shape, place)

    def _person(self, radius: float, height: float, colour: Colour) -> tuple[int, int]:
        """Create an upright capsule, and a visor on its front; return their ids.

        The origin of both is between the feet.
        """
        quarter = np.linspace(-pi / 2, 0, 7)
        foot = [(radius * cos(a), radius + radius * sin(a)) for a in quarter]
        head = [(r, height - z) for r, z in reversed(foot)]
        visor = pybullet.createVisualShape(
            pybullet.GEOM_BOX,
            halfExtents=(0.1, radius * 0.7, 0.07),
            rgbaColor=(*VISOR, 1.0),
            visualFramePosition=(radius - 0.05, 0.0, height - radius),
            physicsClientId=self.client,
        )
        return self._lathe(foot + head, colour), self._body(visor, _AWAY)

    def _switch(self, place: Point, radius: float) -> tuple[int, int]:
        """Create a plate as large as the switch's radius, with a button in its middle; return their ids."""
        plate = [(radius, 0.0), (radius, 0.02), (0.0, 0.02)]
        button = [(0.28, 0.02), (0.28, 0.16), (0.2, 0.2), (0.0, 0.2)]
        return self._lathe(plate, SHUT_SWITCH, place), self._lathe(button, SHUT_SWITCH, place)

    def _beacon(self, place: Point) -> None:
        """Create the mark of an exit: a plate, a pole, and a gem on top of the pole."""
        self._lathe([(0.7, 0.0), (0.7, 0.03), (0.0, 0.03)], EXIT, place)
        self._lathe([(0.06, 0.0), (0.06, 1.9)], EXIT, place)
        self._lathe([(0.0, 1.8), (0.3, 2.2), (0.0, 2.6)], EXIT, place)

    def _body(self, shape: int, place: Point) -> int:
        body: int = pybullet.createMultiBody(0.0, -1, shape, place, physicsClientId=self.client)
        return body

    # Poses

    def _stand(self, person: tuple[int, int], feet: Point, yaw: float) -> None:
        for body in person:
            self._put(body, feet, yaw)

    def _colour(self, bodies: Sequence[int], colour: Colour) -> None:
        for body in bodies:
            pybullet.changeVisualShape(body, -1, rgbaColor=(*colour, 1.0), physicsClientId=self.client)

    def _put(self, body: int, place: Point, yaw: float) -> None:
        turned = (0.0, 0.0, sin(yaw / 2), cos(yaw / 2)) if yaw else UPRIGHT
        pybullet.resetBasePositionAndOrientation(body, place, turned, physicsClientId=self.client)


@lru_cache(maxsize=32)
def _revolve(
    profile: tuple[tuple[float, float], ...], steps: int = 28
) -> tuple[list[list[float]], list[list[float]], list[int]]:
    """Return the mesh of a profile that is turned about the z axis: vertices, normals and triangles.

    ``profile`` has pairs (radius, z). The full turn has ``steps`` steps. Edges of the profile stay
    sharp. The result is cached, because pybullet never frees the lists that it gets: new lists for
    each scene would leak.
    """
    vertices: list[list[float]] = []
    normals: list[list[float]] = []
    indices: list[int] = []
    for (r0, z0), (r1, z1) in pairwise(profile):
        length = float(np.hypot(r1 - r0, z1 - z0))
        out, up = (z1 - z0) / length, (r0 - r1) / length
        first = len(vertices)
        for step in range(steps + 1):
            c, s = cos(2 * pi * step / steps), sin(2 * pi * step / steps)
            vertices += [[r0 * c, r0 * s, z0], [r1 * c, r1 * s, z1]]
            normals += [[out * c, out * s, up]] * 2
        for step in range(steps):
            a = first + 2 * step
            indices += [a, a + 2, a + 1, a + 1, a + 2, a + 3]
    return vertices, normals, indices


def _middle(box: Box) -> Point:
    (x0, y0, z0), (x1, y1, z1) = box.low, box.high
    return (x0 + x1) / 2, (y0 + y1) / 2, (z0 + z1) / 2
