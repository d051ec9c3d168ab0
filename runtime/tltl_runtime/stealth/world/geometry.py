"""Geometry of axis-aligned boxes and upright capsules, such as how deep they overlap."""

from __future__ import annotations

from math import floor, sqrt

from tltl_runtime.stealth.level import Point

Bounds = tuple[Point, Point]
"""The low and high corners of a box."""
TOUCH = 0.02
"""A body may overlap another by this many metres and still count as free of it."""


def group_boxes(boxes: list[Bounds], size: int) -> list[list[Bounds]]:
    """Split boxes into groups of at most ``size`` boxes that are near each other.

    The boxes are halved, across the longer side of the area that they cover, until all groups are
    small enough.
    """
    if len(boxes) <= size:
        return [boxes] if boxes else []
    middles = [[low[axis] + high[axis] for low, high in boxes] for axis in (0, 1)]
    axis = 0 if max(middles[0]) - min(middles[0]) >= max(middles[1]) - min(middles[1]) else 1
    ordered = sorted(boxes, key=lambda box: box[0][axis] + box[1][axis])
    half = len(boxes) // 2
    return group_boxes(ordered[:half], size) + group_boxes(ordered[half:], size)


def boxes_by_cell(boxes: list[Bounds], reach: float) -> dict[tuple[int, int], list[Bounds]]:
    """Return, for each square metre of ground, the boxes within ``reach`` metres of it.

    The key of a square is its south-west corner. Squares without boxes have no key.
    """
    cells: dict[tuple[int, int], list[Bounds]] = {}
    for low, high in boxes:
        for x in range(floor(low[0] - reach), floor(high[0] + reach) + 1):
            for y in range(floor(low[1] - reach), floor(high[1] + reach) + 1):
                cells.setdefault((x, y), []).append((low, high))
    return cells


def depth(feet: Point, height: float, radius: float, low: Point, high: Point) -> float:
    """Return how far an upright capsule at ``feet`` overlaps a box, in metres; negative if they are apart."""
    return contact(feet, height, radius, low, high)[0]


def contact(feet: Point, height: float, radius: float, low: Point, high: Point) -> tuple[float, Point]:
    """Return how far an upright capsule overlaps a box, and the unit vector out of the box.

    The overlap is in metres, negative if the capsule and the box are apart. The capsule stands at
    ``feet``.
    """
    x, y, z = feet
    bottom, top = z + radius, z + height - radius
    dx = x - min(max(x, low[0]), high[0])
    dy = y - min(max(y, low[1]), high[1])
    # Measure between the nearest points of the capsule's axis and of the box.
    if top < low[2]:
        dz = top - low[2]
    elif bottom > high[2]:
        dz = bottom - high[2]
    else:
        dz = 0.0
    distance = sqrt(dx * dx + dy * dy + dz * dz)
    if distance > 0.0:
        return radius - distance, (dx / distance, dy / distance, dz / distance)
    # The axis is inside the box: push out through the nearest side.
    exits = (
        (x - low[0], (-1.0, 0.0, 0.0)),
        (high[0] - x, (1.0, 0.0, 0.0)),
        (y - low[1], (0.0, -1.0, 0.0)),
        (high[1] - y, (0.0, 1.0, 0.0)),
        (top - low[2], (0.0, 0.0, -1.0)),
        (high[2] - bottom, (0.0, 0.0, 1.0)),
    )
    nearest, normal = min(exits)
    return radius + nearest, normal


def box_around(centre: Point, size: Point) -> Bounds:
    """Return the corners of a box of this ``size`` around ``centre``."""
    (x, y, z), (a, b, c) = centre, size
    return (x - a / 2, y - b / 2, z - c / 2), (x + a / 2, y + b / 2, z + c / 2)


def is_inside(point: Point, low: Point, high: Point) -> bool:
    """Whether a point is in a box or on its surface."""
    return all(a <= value <= b for a, value, b in zip(low, point, high, strict=True))


def sides(low: Point, high: Point) -> dict[str, tuple[Point, Point]]:
    """Return two points for each side of a box, by the name of the side, such as ``+x``.

    The first point is 1 cm outside the middle of the side. The second is the middle itself.
    """
    middle = [(a + b) / 2 for a, b in zip(low, high, strict=True)]
    sides: dict[str, tuple[Point, Point]] = {}
    for axis, name in enumerate("xyz"):
        for sign, edge in ((-1, low[axis]), (1, high[axis])):
            outside, face = list(middle), list(middle)
            outside[axis], face[axis] = edge + 0.01 * sign, edge
            key = ("+" if sign > 0 else "-") + name
            sides[key] = ((outside[0], outside[1], outside[2]), (face[0], face[1], face[2]))
    return sides
