"""The coordinates on the map of a level: centimetres of the map from the north-western corner of its bounds.

x points east, y south. A metre on the map is a metre in the level, unless the level is too large or
too small for that.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from tltl_runtime.game.geometry import Box

Rect = tuple[int, int, int, int]
"""A rectangle on a map: left, top, right and bottom, in centimetres."""


class MapScale:
    """Converts the metres of a level to the centimetres of its map.

    ``bounds`` are those of the level. ``metre`` says how many metres of the level a metre on the map
    stands for. ``size`` is the width and the height of the map, in centimetres. ``per_metre`` says how
    many centimetres of the map a metre of the level has.
    """

    def __init__(self, bounds: Box, metre: float = 1.0) -> None:
        (self.west, south, _), (east, self.north, _) = bounds.low, bounds.high
        self.per_metre = 100 / metre
        self.size = (round(self.per_metre * (east - self.west)), round(self.per_metre * (self.north - south)))

    def at(self, point: Sequence[float]) -> tuple[int, int]:
        """Return the map coordinates of a point (x, y) or (x, y, z)."""
        return round(self.per_metre * (point[0] - self.west)), round(self.per_metre * (self.north - point[1]))

    def middle(self, box: Box) -> tuple[int, int]:
        """Return the map coordinates of a box's centre."""
        return self.at([(low + high) / 2 for low, high in zip(box.low, box.high, strict=True)])

    def rect(self, box: Box) -> Rect:
        """Return the rectangle of a box on the map."""
        (left, bottom), (right, top) = self.at(box.low), self.at(box.high)
        return left, top, right, bottom

    def sides(self, box: Box) -> dict[str, int]:
        """Return the rectangle of a box as attributes of an SVG ``rect``."""
        left, top, right, bottom = self.rect(box)
        return {"x": left, "y": top, "width": right - left, "height": bottom - top}

    def line(self, points: Iterable[Sequence[float]]) -> str:
        """Return the ``points`` attribute of an SVG ``polyline`` through these points."""
        return " ".join(f"{x},{y}" for x, y in map(self.at, points))
