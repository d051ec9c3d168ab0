"""Create pybullet bodies in a way that avoids pybullet's pitfalls.

:mod:`~tltl_runtime.stealth.world.physics` lists them.
"""

from __future__ import annotations

from collections.abc import Sequence

from tltl_runtime.stealth.level import Point
from tltl_runtime.stealth.world.bullet import pybullet
from tltl_runtime.stealth.world.geometry import Bounds

COMPOUND = 16
"""The greatest number of children in a compound shape: Bullet drops the rest."""
RAY, PLAYER, PARKED, WORLD = 1, 2, 4, 8
"""The collision groups of rays, of the active capsule, of the inactive one, and of everything else.

Bullet itself puts rays into the first group.
"""
STOPS = RAY | PLAYER
"""The groups that collide with the bodies of the world; the world does not collide with itself."""
UPRIGHT = (0.0, 0.0, 0.0, 1.0)


def static_boxes(client: int, boxes: Sequence[Bounds]) -> int:
    """Create one body of at most 16 boxes, which stands still, and return its id.

    Its collision group is ``WORLD``. Raises ValueError if there are more boxes.
    """
    if len(boxes) > COMPOUND:
        raise ValueError(f"a compound contains at most {COMPOUND} boxes, not {len(boxes)}")
    shape = pybullet.createCollisionShapeArray(
        shapeTypes=[pybullet.GEOM_BOX] * len(boxes),
        halfExtents=[[(b - a) / 2 for a, b in zip(low, high, strict=True)] for low, high in boxes],
        collisionFramePositions=[[(a + b) / 2 for a, b in zip(low, high, strict=True)] for low, high in boxes],
        physicsClientId=client,
    )
    return _static(client, shape, (0.0, 0.0, 0.0))


def static_box(client: int, size: Point, place: Point) -> int:
    """Create a body of one box centred at ``place``, and return its id.

    Its collision group is ``WORLD``. The physics does not move the body, but the caller can.
    """
    half = [side / 2 for side in size]
    shape = pybullet.createCollisionShape(pybullet.GEOM_BOX, halfExtents=half, physicsClientId=client)
    return _static(client, shape, place)


def capsule(client: int, radius: float, height: float, place: Point) -> int:
    """Create a dynamic capsule of 1 kg at ``place``, without rotation and friction, and return its id.

    The capsule collides with nothing until :func:`set_filter` changes that.
    """
    shape = pybullet.createCollisionShape(
        pybullet.GEOM_CAPSULE, radius=radius, height=height - 2 * radius, physicsClientId=client
    )
    body: int = pybullet.createMultiBody(1.0, shape, _tiny_shape(client), place, physicsClientId=client)
    pybullet.changeDynamics(
        body,
        -1,
        localInertiaDiagonal=(0.0, 0.0, 0.0),
        lateralFriction=0.0,
        spinningFriction=0.0,
        rollingFriction=0.0,
        restitution=0.0,
        linearDamping=0.0,
        angularDamping=0.0,
        physicsClientId=client,
    )
    set_filter(client, body, PARKED, 0)
    return body


def set_filter(client: int, body: int, group: int, mask: int) -> None:
    """Set the collision group of a body, and the groups that it collides with."""
    pybullet.setCollisionFilterGroupMask(body, -1, group, mask, physicsClientId=client)


def _static(client: int, shape: int, place: Point) -> int:
    body: int = pybullet.createMultiBody(
        0.0, shape, _tiny_shape(client), place, useMaximalCoordinates=1, physicsClientId=client
    )
    pybullet.changeDynamics(body, -1, lateralFriction=0.0, restitution=0.0, physicsClientId=client)
    set_filter(client, body, WORLD, STOPS)
    return body


def _tiny_shape(client: int) -> int:
    """Create a visual shape that is too small to see.

    Without a visual shape, pybullet would draw the collision shape.
    """
    corners = [[0.0, 0.0, 0.0], [0.001, 0.0, 0.0], [0.0, 0.001, 0.0]]
    shape: int = pybullet.createVisualShape(
        pybullet.GEOM_MESH, vertices=corners, indices=[0, 1, 2], physicsClientId=client
    )
    return shape
