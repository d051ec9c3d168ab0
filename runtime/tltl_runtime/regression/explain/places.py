"""Names, in words, of places in a level."""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot
from statistics import fmean
from typing import Final

from tltl_runtime.game.geometry import Box, Point
from tltl_runtime.game.level import Level
from tltl_runtime.game.registry import registered_game

_NEAR: Final = 2.5
"""A place within this many metres of an entity is near it."""

_BESIDE: Final = 0.99
"""A box hides another one only if it is met before this share of the way to it; otherwise it stands beside it."""

_TOUCHING: Final = 0.7
"""A solid is in the way of a player if it is within this many metres of the player's centre."""


def place_name(level: Level, point: Point) -> str:
    """Describe where a point is: ``in the corridor``, else ``near `s2```, else ``in the north-east``."""
    for region in level.regions:
        if _distance(point, region.box) == 0.0:
            return f"in the {region.name.replace('_', ' ')}"
    entity = nearest_entity(level, point)
    return f"near `{entity}`" if entity else f"in the {_quarter(level.bounds, point)}"


def nearest_entity(level: Level, point: Point) -> str | None:
    """The nearest switch, exit or barrier; None if none is within 2.5 m."""
    positions = registered_game().landmarks(level)
    near = [(hypot(x - point[0], y - point[1]), name) for name, (x, y, _) in positions.items()]
    distance, name = min(near, default=(2 * _NEAR, ""))
    return name if distance <= _NEAR else None


def in_the_way(level: Level, ends: Sequence[tuple[Point, Sequence[str]]]) -> list[str]:
    """The solids and closed barriers that more than half of the players touch, most frequent and nearest first.

    The floor does not count.  ``ends`` are the positions of the players' feet, each with the names of
    the barriers that were closed then.
    """
    game = registered_game()
    solids, barriers = game.solids(level), game.barriers(level)
    touched: dict[str, list[float]] = {}
    for feet, shut in ends:
        boxes = solids | {name: barriers[name] for name in shut if name in barriers}
        near = {name: distance for name, box in boxes.items() if (distance := _beside(feet, box)) <= _TOUCHING}
        for name, distance in near.items():
            if not any(_hides(boxes[other], feet, boxes[name]) for other in near if near[other] < distance):
                touched.setdefault(name, []).append(distance)
    often = [name for name, distances in touched.items() if 2 * len(distances) > len(ends)]
    return sorted(often, key=lambda name: (-len(touched[name]), fmean(touched[name])))


def _beside(feet: Point, box: Box) -> float:
    """The horizontal distance from a player to a box; infinite for a box below the feet, such as one to stand on."""
    body = (*feet[:2], max(feet[2], box.low[2]))
    return _distance(body, box) if box.high[2] > feet[2] + 0.1 else float("inf")


def _hides(box: Box, feet: Point, other: Box) -> bool:
    """Whether a box stands between a player and another box, seen from above; both boxes must overlap in height."""
    first, last = 0.0, 1.0
    for at, low, high, near, far in zip(feet[:2], box.low, box.high, other.low, other.high, strict=False):
        way = min(max(at, near), far) - at
        if way == 0.0:
            first, last = (first, last) if low <= at <= high else (1.0, 0.0)
        else:
            enters, leaves = sorted(((low - at) / way, (high - at) / way))
            first, last = max(first, enters), min(last, leaves)
    # A box that is met at the very end of the way stands beside the other box.
    return first <= last and first < _BESIDE and box.low[2] < other.high[2] and other.low[2] < box.high[2]


def _distance(point: Point, box: Box) -> float:
    """The horizontal distance from a point to a box; infinite if the point is over 0.5 m below or above the box."""
    if not box.low[2] - 0.5 <= point[2] <= box.high[2] + 0.5:
        return float("inf")
    offsets = [max(low - at, 0.0, at - high) for at, low, high in zip(point[:2], box.low, box.high, strict=False)]
    return hypot(*offsets)


def _quarter(bounds: Box, point: Point) -> str:
    """The part of the level in which a point lies, by compass direction, or ``middle``."""
    share = [(at - low) / (high - low) for at, low, high in zip(point, bounds.low, bounds.high, strict=True)]
    north = "north" if share[1] > 2 / 3 else "south" if share[1] < 1 / 3 else ""
    east = "east" if share[0] > 2 / 3 else "west" if share[0] < 1 / 3 else ""
    return "-".join(filter(None, (north, east))) or "middle"
