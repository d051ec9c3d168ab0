"""A prediction of :mod:`~tltl_runtime.stealth.world.physics` for thousands of bodies at once.

A body is a copy of the player: a capsule, which boxes push out. The predicted motion agrees with
the physics to within a few centimetres. A body touches a mover (a moving box) if the mover comes
within 6 cm of the body in the same decision (time step).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.stealth.level import Box
from tltl_runtime.stealth.world.player import DECISION, SIGN, SUBSTEPS, PlayerKind, PlayerState
from tltlc.api import record

Floats = NDArray[np.float64]
Truths = NDArray[np.bool_]

_TOUCH: Final = 0.02
"""A body at most this far from a surface stands on it, in metres."""
_COARSE: Final = 3
"""The number of physics steps in a decision if all bodies walk."""
_BERTH: Final = 0.06
"""The distance to keep from movers, in metres."""


@record
class Poses:
    """The states of n bodies, which are copies of the player; each field is an array [n].

    ``x``, ``y`` and ``z`` are the positions of the feet in metres, ``vz`` the upward speeds in m/s,
    ``stamina`` is in [0, 1].
    """

    x: Floats
    y: Floats
    z: Floats
    vz: Floats
    crouching: Truths
    grounded: Truths
    stamina: Floats

    def take(self, indices: Any) -> Poses:
        """Return the states of the bodies with these indices, which may be a mask."""
        return Poses(*(getattr(self, name)[indices] for name in _FIELDS))


_FIELDS: Final = ("x", "y", "z", "vz", "crouching", "grounded", "stamina")


def poses_of(state: PlayerState) -> Poses:
    """Return the player's ``state`` as :class:`Poses` with one body."""
    x, y, z = state.position
    values = (x, y, z, state.velocity[2], state.crouching, state.grounded, state.stamina)
    return Poses(*(np.array([value]) for value in values))


def concatenate(parts: Sequence[Poses]) -> Poses:
    """Return the bodies of all ``parts``, in this order, in one :class:`Poses`."""
    return Poses(*(np.concatenate([getattr(part, name) for part in parts]) for name in _FIELDS))


@record
class _Boxes:
    """Boxes as arrays [3, boxes] of x, y and z in metres: their lowest and their highest corners."""

    low: Floats
    high: Floats


class Motion:
    """Predicts how copies of a player of this ``kind`` move among ``boxes`` that stand still."""

    def __init__(self, kind: PlayerKind, boxes: Sequence[Box]) -> None:
        self.kind = kind
        corners = np.array([[*box.low, *box.high] for box in boxes], dtype=np.float64).reshape(-1, 6)
        self._boxes = _Boxes(corners[:, :3].T, corners[:, 3:].T)

    def step(self, poses: Poses, actions: NDArray[np.int64], movers: Sequence[Box] = ()) -> tuple[Poses, Truths]:
        """Return the states of the bodies one time step later, and which bodies touched a mover.

        ``actions`` [n, 5] are the actions of the bodies. ``movers`` are the boxes that the movers
        (moving boxes) sweep in this time step.
        """
        kind = self.kind
        boxes = self._boxes_near(poses)
        crouching = (actions[:, 3] > 0) | (poses.crouching & ~self._has_room(poses, boxes))
        vx, vy, stamina = self._wish(poses, actions, crouching)
        jumps = (actions[:, 2] > 0) & poses.grounded & ~crouching
        height = np.where(crouching, kind.crouched_height, kind.height)
        x, y, z = poses.x.copy(), poses.y.copy(), poses.z.copy()
        lift = np.where(jumps | ~poses.grounded, 0.0, self._stairs(poses, vx, vy, height, boxes))
        z += lift
        vz = np.where(jumps, kind.jump_speed, np.maximum(poses.vz, -kind.fall_speed))
        vz[lift > 0.0] = 0.0
        substeps = SUBSTEPS if (jumps | ~poses.grounded).any() else _COARSE
        seconds = DECISION / substeps
        touched = np.zeros(x.shape, dtype=np.bool_)
        for _ in range(substeps):
            vz -= kind.gravity * seconds
            x += vx * seconds
            y += vy * seconds
            z += vz * seconds
            for box in movers:
                touched |= _meets(x, y, z, height, kind.radius + _BERTH, box)
            self._push_out(x, y, z, vx, vy, vz, height, boxes)
        depth, normal = self._contacts(x, y, z, height, boxes)
        grounded = ((depth > -_TOUCH) & (normal[2] > 0.5)).any(axis=1)
        return Poses(x, y, z, vz, crouching, grounded, stamina), touched

    def _wish(self, poses: Poses, actions: NDArray[np.int64], crouching: Truths) -> tuple[Floats, Floats, Floats]:
        """Return the speeds along x and y that the actions request, and the stamina that is left.

        See :func:`tltl_runtime.stealth.world.player.control`.
        """
        kind = self.kind
        sign = np.array(SIGN)
        dx, dy = sign[actions[:, 0]], sign[actions[:, 1]]
        spent = DECISION / kind.stamina_time
        sprints = (actions[:, 4] > 0) & ((dx != 0) | (dy != 0)) & ~crouching & (poses.stamina >= spent - 1e-9)
        speed = np.where(sprints, kind.sprint_speed, np.where(crouching, kind.crouch_speed, kind.walk_speed))
        speed = speed / np.maximum(np.hypot(dx, dy), 1.0)
        refilled = np.minimum(1.0, poses.stamina + DECISION / kind.refill_time)
        return dx * speed, dy * speed, np.where(sprints, np.maximum(0.0, poses.stamina - spent), refilled)

    def _boxes_near(self, poses: Poses) -> _Boxes:
        """Return the boxes that any of the bodies can touch in one time step."""
        reach = self.kind.radius + self.kind.sprint_speed * DECISION + _TOUCH
        low, high = self._boxes.low, self._boxes.high
        near = (low[0] < poses.x.max() + reach) & (high[0] > poses.x.min() - reach)
        near &= (low[1] < poses.y.max() + reach) & (high[1] > poses.y.min() - reach)
        return _Boxes(low[:, near], high[:, near])

    def _stairs(self, poses: Poses, vx: Floats, vy: Floats, height: Floats, boxes: _Boxes) -> Floats:
        """Return how far a stair lifts each body, in metres; 0 if there is no stair in the body's way."""
        lift = np.zeros(poses.x.shape)
        kind = self.kind
        low, high = boxes.low, boxes.high
        stairs = (high[2] > poses.z[:, None] + _TOUCH) & (high[2] <= poses.z[:, None] + kind.step_height + _TOUCH)
        reach = kind.radius + kind.sprint_speed * DECISION
        stairs &= (np.maximum(low[0] - poses.x[:, None], poses.x[:, None] - high[0]) < reach) & (
            np.maximum(low[1] - poses.y[:, None], poses.y[:, None] - high[1]) < reach
        )
        candidates = np.flatnonzero(stairs.any(axis=1) & ((vx != 0.0) | (vy != 0.0)))
        if not candidates.size:
            return lift
        candidate_poses, z = poses.take(candidates), poses.z[candidates, None]
        in_way = (z + _TOUCH < high[2]) & (low[2] < z + kind.radius)
        for wx, wy in ((vx, vy), (vx, np.zeros_like(vx)), (np.zeros_like(vy), vy)):
            undecided = np.ones(candidates.size, dtype=np.bool_)
            for share in (1 / 3, 2 / 3, 1.0):
                ahead_x, ahead_y = (
                    candidate_poses.x + wx[candidates] * DECISION * share,
                    candidate_poses.y + wy[candidates] * DECISION * share,
                )
                depth, _ = self._contacts(ahead_x, ahead_y, candidate_poses.z, height[candidates], boxes)
                tops = np.where(in_way & (depth > _TOUCH), high[2], -np.inf).max(axis=1)
                step = tops - candidate_poses.z + 0.005
                first = undecided & np.isfinite(tops)
                lift[candidates] = np.where(
                    first & (step <= kind.step_height + _TOUCH), np.maximum(lift[candidates], step), lift[candidates]
                )
                undecided &= ~first
        return lift

    def _has_room(self, poses: Poses, boxes: _Boxes) -> Truths:
        """Return for each body whether it has room to stand."""
        depth, _ = self._contacts(poses.x, poses.y, poses.z, np.full(poses.x.shape, self.kind.height), boxes)
        free: Truths = np.logical_and.reduce(depth <= _TOUCH, axis=1)
        return free

    def _push_out(
        self, x: Floats, y: Floats, z: Floats, vx: Floats, vy: Floats, vz: Floats, height: Floats, boxes: _Boxes
    ) -> None:
        """Move the bodies out of the boxes that they overlap, and stop their motion into these boxes.

        The positions and speeds are modified in place.
        """
        depth, normal = self._contacts(x, y, z, height, boxes)
        touched = np.flatnonzero((depth > 0.0).any(axis=1))
        if not touched.size:
            return
        deep, normal = np.maximum(depth[touched], 0.0), normal[:, touched]
        for axis, place in enumerate((x, y, z)):
            push = deep * normal[axis]
            place[touched] += push.max(axis=1, initial=0.0) + push.min(axis=1, initial=0.0)
        # Remove the speed into the box that it points into most; then do the same with the remaining speed.
        speed = np.stack([vx[touched], vy[touched], vz[touched]])
        rows = np.arange(touched.size)
        for _ in range(2):
            against = np.where(deep > 0.0, (speed[:, :, None] * normal).sum(axis=0), 0.0)
            worst = against.argmin(axis=1)
            lost = np.minimum(against[rows, worst], 0.0)
            speed -= lost * normal[:, rows, worst]
        vx[touched], vy[touched], vz[touched] = speed

    def _contacts(self, x: Floats, y: Floats, z: Floats, height: Floats, boxes: _Boxes) -> tuple[Floats, Floats]:
        """Return how far each capsule overlaps each box, and the unit vectors out of the boxes.

        The overlap is in metres, negative if the capsule and the box are apart. The shapes of the
        results are [n, boxes] and [3, n, boxes].
        """
        radius = self.kind.radius
        low, high = boxes.low, boxes.high
        away = np.empty((3, x.size, low.shape[1]))
        for axis, place in enumerate((x, y)):
            away[axis] = place[:, None] - np.minimum(np.maximum(place[:, None], low[axis]), high[axis])
        bottom, top = (z + radius)[:, None], (z + height - radius)[:, None]
        away[2] = np.where(top < low[2], top - low[2], np.maximum(bottom - high[2], 0.0))
        distance = np.sqrt((away * away).sum(axis=0))
        inside = distance < 1e-9
        away[2][inside] = 1.0
        return radius - distance, away / np.where(inside, 1.0, distance)


def _meets(x: Floats, y: Floats, z: Floats, height: Floats, radius: float, box: Box) -> Truths:
    """Return for each capsule of ``radius`` and ``height`` whether it overlaps a box.

    ``x``, ``y`` and ``z`` are the positions of the feet.
    """
    dx = np.maximum(np.maximum(box.low[0] - x, x - box.high[0]), 0.0)
    dy = np.maximum(np.maximum(box.low[1] - y, y - box.high[1]), 0.0)
    dz = np.maximum(np.maximum(box.low[2] - (z + height - radius), z + radius - box.high[2]), 0.0)
    meets: Truths = dx * dx + dy * dy + dz * dz < radius * radius
    return meets
