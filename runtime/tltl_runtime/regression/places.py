"""What people call a place in a level."""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot
from typing import Final

from tltl_runtime.stealth.level import Box, Level, Point, fixed_places

_NEAR: Final = 2.5
"""Metres to an entity beside which a place is."""

_TOUCHING: Final = 0.7
"""Metres from the middle of a player to a solid that is in its way."""


def place_name(level: Level, point: Point) -> str:
    """Where a point is: ``in the corridor``, else ``near `s2```, else ``in the north-east``."""
    for region in level.regions:
        if _distance(point, region.box) == 0.0:
            return f"in the {region.name.replace('_', ' ')}"
    found = nearest_entity(level, point)
    return f"near `{found}`" if found else f"in the {_quarter(level.bounds, point)}"


def nearest_entity(level: Level, point: Point) -> str | None:
    """The switch, exit or barrier next to a point, None where none is within 2.5 m."""
    there = fixed_places(level)
    near = [(hypot(x - point[0], y - point[1]), name) for name, (x, y, _) in there.items()]
    distance, name = min(near, default=(2 * _NEAR, ""))
    return name if distance <= _NEAR else None


def obstacle(level: Level, points: Sequence[Point]) -> str | None:
    """The solid that most of the points, those of players' feet, touch; the floor is none."""
    counts: dict[str, int] = {}
    solids = [solid for solid in level.solids if solid.kind != "floor"]
    for point in points:
        above = [solid for solid in solids if solid.box.high[2] > point[2] + 0.1]
        near = [(_distance((*point[:2], max(point[2], s.box.low[2])), s.box), s.name) for s in above]
        distance, name = min(near, default=(2 * _TOUCHING, ""))
        if distance <= _TOUCHING:
            counts[name] = counts.get(name, 0) + 1
    name = max(counts, key=lambda each: counts[each], default="")
    return name if name and 2 * counts[name] > len(points) else None


def _distance(point: Point, box: Box) -> float:
    """From a point to a box, on the plan; far where the point is more than half a metre below or above the box."""
    if not box.low[2] - 0.5 <= point[2] <= box.high[2] + 0.5:
        return float("inf")
    away = [max(low - at, 0.0, at - high) for at, low, high in zip(point[:2], box.low, box.high, strict=False)]
    return hypot(*away)


def _quarter(bounds: Box, point: Point) -> str:
    """The part of the level, as on a map."""
    share = [(at - low) / (high - low) for at, low, high in zip(point, bounds.low, bounds.high, strict=True)]
    north = "north" if share[1] > 2 / 3 else "south" if share[1] < 1 / 3 else ""
    east = "east" if share[0] > 2 / 3 else "west" if share[0] < 1 / 3 else ""
    return "-".join(filter(None, (north, east))) or "middle"
