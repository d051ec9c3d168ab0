"""Describe places in a level in words."""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot
from statistics import fmean
from typing import Final

from tltl_runtime.game.geometry import Box, Point
from tltl_runtime.game.level import Level
from tltl_runtime.game.mentions import Mentions, region_text
from tltl_runtime.regression.explain.phrase import Phrase, phrase, things_phrase

_NEAR_M: Final = 2.5
"""A place is near an entity if the distance between them is at most this, in metres."""

_BESIDE: Final = 0.99
"""A box hides a target only if the line from the player to the target enters the box early enough.

The point of entry must lie within the first 99 % of the line.
"""

_TOUCHING_M: Final = 0.7
"""A solid blocks a player if it is within this many metres of the player's centre."""


def place_phrase(level: Level, point: Point) -> Phrase:
    """Describe where a point is: by its region, else by an entity near it, else by a direction.

    Examples: ``in the corridor``, ``near `s2```, ``in the north-east``. The phrase is empty if the point
    is in no region and near no entity, and the bounds of the level are not known.
    """
    for region in level.regions:
        if _distance(point, region.box) == 0.0:
            return Phrase(f"in the {region_text(region.name)}", Mentions(regions=(region.name,)))
    entity = nearest_entity(level, point)
    if entity:
        return phrase("near ", things_phrase([entity]))
    return Phrase("" if level.bounds is None else f"in the {_quarter(level.bounds, point)}")


def nearest_entity(level: Level, point: Point) -> str | None:
    """Return the name of the nearest entity that does not move, such as a switch; None if none is within 2.5 m."""
    positions = level.game.landmarks(level)
    near = [(hypot(x - point[0], y - point[1]), name) for name, (x, y, _) in positions.items()]
    distance, name = min(near, default=(2 * _NEAR_M, ""))
    return name if distance <= _NEAR_M else None


def blocking_solids(level: Level, players: Sequence[tuple[Point, Sequence[str]]]) -> list[str]:
    """Return the names of the solids and closed barriers that more than half of the players touch.

    ``players`` has a pair for each player: the position of the feet, and the names of the barriers
    that were closed then. The boxes that most players touch come first. If equally many players
    touch two boxes, the box that is nearer on average comes first. The floor does not count, nor
    does a box that is hidden from the player behind a nearer box.
    """
    solids, barriers = level.game.solids(level), level.game.barriers(level)
    touched: dict[str, list[float]] = {}
    for feet, closed in players:
        boxes = solids | {name: barriers[name] for name in closed if name in barriers}
        near = {
            name: distance for name, box in boxes.items() if (distance := _distance_to_body(feet, box)) <= _TOUCHING_M
        }
        for name, distance in near.items():
            if not any(_hides(boxes[nearer], feet, boxes[name]) for nearer in near if near[nearer] < distance):
                touched.setdefault(name, []).append(distance)
    frequent = [name for name, distances in touched.items() if 2 * len(distances) > len(players)]
    return sorted(frequent, key=lambda name: (-len(touched[name]), fmean(touched[name])))


def _distance_to_body(feet: Point, box: Box) -> float:
    """Return the horizontal distance from a player to a box, in metres.

    It is infinite for a box below the feet, such as a box that the player stands on. It does not
    matter how high above the feet a box is.
    """
    body = (*feet[:2], max(feet[2], box.low[2]))
    return _distance(body, box) if box.high[2] > feet[2] + 0.1 else float("inf")


def _hides(box: Box, feet: Point, target: Box) -> bool:
    """Whether ``box`` stands between a player and the box ``target``.

    Seen from above, it must lie on the line from the feet to the nearest point of the target. The
    two boxes must also overlap in height.
    """
    first, last = 0.0, 1.0
    for at, low, high, near, far in zip(feet[:2], box.low, box.high, target.low, target.high, strict=False):
        offset = min(max(at, near), far) - at
        if offset == 0.0:
            first, last = (first, last) if low <= at <= high else (1.0, 0.0)
        else:
            enters, leaves = sorted(((low - at) / offset, (high - at) / offset))
            first, last = max(first, enters), min(last, leaves)
    # If the line meets the box only at the end of the line, the box stands beside the target.
    return first <= last and first < _BESIDE and box.low[2] < target.high[2] and target.low[2] < box.high[2]


def _distance(point: Point, box: Box) -> float:
    """Return the horizontal distance from a point to a box, in metres.

    It is infinite if the point is over 0.5 m below or above the box.
    """
    if not box.low[2] - 0.5 <= point[2] <= box.high[2] + 0.5:
        return float("inf")
    offsets = [max(low - at, 0.0, at - high) for at, low, high in zip(point[:2], box.low, box.high, strict=False)]
    return hypot(*offsets)


def _quarter(bounds: Box, point: Point) -> str:
    """Return the part of the level in which a point lies: a compass direction, or ``middle``."""
    share = [(at - low) / (high - low) for at, low, high in zip(point, bounds.low, bounds.high, strict=True)]
    north = "north" if share[1] > 2 / 3 else "south" if share[1] < 1 / 3 else ""
    east = "east" if share[0] > 2 / 3 else "west" if share[0] < 1 / 3 else ""
    return "-".join(filter(None, (north, east))) or "middle"
