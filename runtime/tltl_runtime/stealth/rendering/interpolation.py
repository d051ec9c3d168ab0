"""Interpolate between two snapshots of the game, for smooth motion."""

from __future__ import annotations

from math import pi

from tltl_runtime.stealth.level import Point
from tltl_runtime.stealth.snapshot import Snapshot
from tltlc.api import replace


def interpolate(before: Snapshot, after: Snapshot, share: float) -> Snapshot:
    """Return a snapshot between ``before`` (share 0) and ``after`` (share 1).

    The time and the poses of bodies are interpolated. Everything else is as in ``after``.
    """
    if share >= 1.0:
        return after
    player = replace(
        after.player,
        position=_point(before.player.position, after.player.position, share),
        yaw=_angle(before.player.yaw, after.player.yaw, share),
    )
    return replace(
        after,
        time=before.time + share * (after.time - before.time),
        player=player,
        enemies=_points(before.enemies, after.enemies, share),
        yaws=tuple(_angle(*yaws, share) for yaws in zip(before.yaws, after.yaws, strict=True)),
        movers=_points(before.movers, after.movers, share),
    )


def _points(before: tuple[Point, ...], after: tuple[Point, ...], share: float) -> tuple[Point, ...]:
    return tuple(_point(*points, share) for points in zip(before, after, strict=True))


def _point(before: Point, after: Point, share: float) -> Point:
    x, y, z = (a + share * (b - a) for a, b in zip(before, after, strict=True))
    return x, y, z


def _angle(before: float, after: float, share: float) -> float:
    """Interpolate between two yaws, in radians, along the shorter turn."""
    return before + share * ((after - before + pi) % (2 * pi) - pi)
