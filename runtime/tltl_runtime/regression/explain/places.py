"""What people call a place in a level."""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot
from statistics import fmean
from typing import Final

from tltl_runtime.stealth.level import Box, Level, Point, fixed_places

_NEAR: Final = 2.5
"""Metres to an entity beside which a place is."""

_BESIDE: Final = 0.99
"""Of the way from a player to a box: what is met later is beside it."""

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


def in_the_way(level: Level, ends: Sequence[tuple[Point, Sequence[str]]]) -> list[str]:
    """The solids and the shut barriers that most players touch, the most frequent and nearest first; the floor is none.

    ``ends`` are where the players' feet are, each with the names of the barriers that are shut then.
    """
    solids = {each.name: each.box for each in level.solids if each.kind != "floor"}
    barriers = {each.name: each.box for each in level.barriers}
    touched: dict[str, list[float]] = {}
    for feet, shut in ends:
        there = solids | {name: barriers[name] for name in shut if name in barriers}
        near = {name: away for name, box in there.items() if (away := _beside(feet, box)) <= _TOUCHING}
        for name, away in near.items():
            if not any(_hides(there[other], feet, there[name]) for other in near if near[other] < away):
                touched.setdefault(name, []).append(away)
    often = [name for name, each in touched.items() if 2 * len(each) > len(ends)]
    return sorted(often, key=lambda name: (-len(touched[name]), fmean(touched[name])))


def _beside(feet: Point, box: Box) -> float:
    """From a player to a box beside it, on the plan; far from what is below the feet, such as a box to stand on."""
    body = (*feet[:2], max(feet[2], box.low[2]))
    return _distance(body, box) if box.high[2] > feet[2] + 0.1 else float("inf")


def _hides(box: Box, feet: Point, other: Box) -> bool:
    """Whether a box stands between a player and another box: on the plan, and not above or below that."""
    first, last = 0.0, 1.0
    for at, low, high, near, far in zip(feet[:2], box.low, box.high, other.low, other.high, strict=False):
        way = min(max(at, near), far) - at
        if way == 0.0:
            first, last = (first, last) if low <= at <= high else (1.0, 0.0)
        else:
            enters, leaves = sorted(((low - at) / way, (high - at) / way))
            first, last = max(first, enters), min(last, leaves)
    # What is met where the way ends is beside it.
    return first <= last and first < _BESIDE and box.low[2] < other.high[2] and other.low[2] < box.high[2]


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
