"""Render pictures of a level from snapshots.

The views are those of :mod:`~tltl_runtime.stealth.rendering.camera`. Pybullet's TinyRenderer draws
the bodies. It needs neither a display nor a graphics card, and draws the same picture for the same
snapshot; see docs/adr/0010-pictures-and-windows.md.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.stealth.enemies.segments import corners, is_blocked
from tltl_runtime.stealth.level import Box, Point, StealthLevel
from tltl_runtime.stealth.rendering.camera import Camera, View, camera, check_size, pixels
from tltl_runtime.stealth.rendering.cone import SightField
from tltl_runtime.stealth.rendering.paint import Canvas
from tltl_runtime.stealth.rendering.scene import Colour, Obstacle, Scene
from tltl_runtime.stealth.snapshot import Snapshot
from tltl_runtime.stealth.world.bullet import pybullet
from tltl_runtime.stealth.world.player import PlayerKind

_LASER: Final[Colour] = (1.0, 0.15, 0.2)
_SEEING: Final[Colour] = (1.0, 0.08, 0.12)
"""The colour of the field of sight of an enemy that sees the player."""
_SIGHT: Final[dict[str, Colour]] = {
    "patrol": (1.0, 0.72, 0.1),
    "chase": (1.0, 0.12, 0.12),
    "search": (1.0, 0.42, 0.08),
    "return": (0.35, 0.6, 0.95),
}
"""The colour of the field of sight of an enemy that does not see the player, by its mode."""

_LIGHT: Final = (-0.45, -0.8, 1.6)
_GLASS: Final = 0.22
_SHADOW: Final = 0.6
_OVERHEAD: Final = 1.0
"""In the view from above, boxes that begin above this height, in metres, are drawn as glass."""


class Renderer:
    """Draws snapshots of a level as pictures of ``width`` by ``height`` pixels.

    The picture is drawn ``samples`` times as wide and as high, and then each pixel is the mean of
    ``samples`` by ``samples`` of its pixels. Raises ValueError if
    :func:`~tltl_runtime.stealth.rendering.camera.check_size` rejects the size, or the size times
    ``samples``.
    """

    def __init__(self, level: StealthLevel, width: int = 640, height: int = 480, samples: int = 1) -> None:
        self.level = level
        self.width, self.height = check_size((width, height))
        self.samples = samples
        check_size((width * samples, height * samples))
        self._scene = Scene(level)
        self._kind = PlayerKind()

    def close(self) -> None:
        """Release the bodies; the renderer cannot be used afterwards.

        Closing twice does nothing.
        """
        self._scene.close()

    def frame(self, snapshot: Snapshot, view: View = "third_person") -> NDArray[np.uint8]:
        """Return the picture of a snapshot, (height, width, 3)."""
        eye = camera(self.level, view, snapshot.player.position, self.width / self.height)
        obstacles = self._scene.obstacles(snapshot)
        glass = [obstacle for obstacle in obstacles if self._is_glass(obstacle.box, eye, view, snapshot)]
        self._scene.pose(snapshot, [obstacle for obstacle in obstacles if obstacle not in glass])
        canvas = self._draw_bodies(eye)
        for feet in (snapshot.player.position, *snapshot.enemies):
            canvas.shadow(feet, _SHADOW)
        self._paint_sight(canvas, snapshot, [obstacle.box for obstacle in obstacles])
        self._paint_glass(canvas, snapshot, glass)
        picture = canvas.picture
        if self.samples > 1:
            picture = picture.reshape(self.height, self.samples, self.width, self.samples, 3).mean(axis=(1, 3))
        return (picture.clip(0.0, 1.0) * 255 + 0.5).astype(np.uint8)

    def names(self, snapshot: Snapshot, view: View = "third_person") -> list[tuple[str, float, float]]:
        """Return the names of the entities that the picture shows, each with its x and y in pixels.

        Open barriers have no names.
        """
        eye = camera(self.level, view, snapshot.player.position, self.width / self.height)
        named = [(switch.name, switch.position, 0.3) for switch in self.level.switches]
        named += [(exit_.name, exit_.position, 2.7) for exit_ in self.level.exits]
        named += [
            (barrier.name, _top(barrier.box), 0.1)
            for barrier, is_open in zip(self.level.barriers, snapshot.open, strict=True)
            if not is_open
        ]
        movers = zip(self.level.movers, snapshot.movers, strict=True)
        named += [(mover.name, place, mover.size[2] / 2 + 0.1) for mover, place in movers]
        named += [(enemy.name, place, 2.0) for enemy, place in zip(self.level.enemies, snapshot.enemies, strict=True)]
        if not named:
            return []
        places = np.array([(x, y, z + above) for _, (x, y, z), above in named])
        positions = pixels(eye, places, self.width, self.height)
        are_in_picture = (positions >= 0).all(axis=1) & (positions < (self.width, self.height)).all(axis=1)
        are_in_picture &= (places - np.array(eye.eye)) @ (np.array(eye.target) - np.array(eye.eye)) > 0
        return [
            (name, float(x), float(y))
            for (name, *_), (x, y), is_drawn in zip(named, positions, are_in_picture, strict=True)
            if is_drawn
        ]

    def _draw_bodies(self, eye: Camera) -> Canvas:
        """Draw the bodies, the pattern of the floor and the background from the camera ``eye``."""
        width, height = self.width * self.samples, self.height * self.samples
        _, _, colours, depths, bodies = pybullet.getCameraImage(
            width,
            height,
            pybullet.computeViewMatrix(eye.eye, eye.target, eye.up),
            pybullet.computeProjectionMatrixFOV(eye.field, width / height, eye.near, eye.far),
            lightDirection=_LIGHT,
            lightAmbientCoeff=0.62,
            lightDiffuseCoeff=0.42,
            lightSpecularCoeff=0.0,
            shadow=0,
            renderer=pybullet.ER_TINY_RENDERER,
            physicsClientId=self._scene.client,
        )
        picture = np.asarray(np.reshape(colours, (height, width, 4))[..., :3] / np.float32(255), np.float32)
        body_ids = np.reshape(bodies, (height, width))
        depth = np.reshape(depths, (height, width)).astype(np.float32)
        metres = np.asarray(eye.near * eye.far / (eye.far - (eye.far - eye.near) * depth), np.float32)
        canvas = Canvas(picture, metres, eye)
        canvas.tiles(np.isin(body_ids, self._scene.floors))
        canvas.edges(body_ids)
        canvas.background(body_ids < 0)
        return canvas

    def _paint_sight(self, canvas: Canvas, snapshot: Snapshot, boxes: list[Box]) -> None:
        for index, enemy in enumerate(self.level.enemies):
            field = SightField(enemy.kind, snapshot.enemies[index], snapshot.yaws[index], boxes)
            if snapshot.sees[index]:
                canvas.field(field, _SEEING, 0.6)
            else:
                canvas.field(field, _SIGHT[snapshot.modes[index]], 0.42)

    def _paint_glass(self, canvas: Canvas, snapshot: Snapshot, glass: list[Obstacle]) -> None:
        """Paint the shut lasers and the obstacles that are drawn as glass, from far to near."""
        panes = [(obstacle.box, obstacle.colour, _GLASS) for obstacle in glass]
        panes += [
            (barrier.box, _LASER, 0.5)
            for barrier, is_open in zip(self.level.barriers, snapshot.open, strict=True)
            if barrier.kind == "laser" and not is_open
        ]
        for box, colour, strength in sorted(panes, key=lambda pane: -_distance(canvas.camera.eye, pane[0])):
            canvas.glass(box.low, box.high, colour, strength)

    def _is_glass(self, box: Box, eye: Camera, view: View, snapshot: Snapshot) -> bool:
        """Whether to draw a box as glass.

        A box is glass if it hides the player, or if it hides much of the level: the south wall, or
        in the view from above a box overhead.
        """
        if view == "top_down" and box.low[2] > _OVERHEAD:
            return True
        if view != "top_down" and _is_front(box, self.level.bounds):
            return True
        x, y, z = snapshot.player.position
        height = self._kind.crouched_height if snapshot.player.crouching else self._kind.height
        return any(is_blocked(eye.eye, (x, y, z + share * height), (corners(box),)) for share in (0.5, 0.95))


def _top(box: Box) -> Point:
    """Return the middle of a box's upper side."""
    return (box.low[0] + box.high[0]) / 2, (box.low[1] + box.high[1]) / 2, box.high[2]


def _is_front(box: Box, bounds: Box) -> bool:
    """Whether a box covers the whole south side of the level."""
    return box.low[1] <= bounds.low[1] and box.low[0] <= bounds.low[0] and box.high[0] >= bounds.high[0]


def _distance(eye: Point, box: Box) -> float:
    return float(np.linalg.norm(np.add(box.low, box.high) / 2 - np.array(eye)))
