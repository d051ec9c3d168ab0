"""Points, boxes and regions in a level, in metres.

x points east, y north, z up. Boxes are parallel to the axes.
"""

from __future__ import annotations

from tltlc.api import record

Point = tuple[float, float, float]


@record
class Box:
    """A box from corner ``low`` to corner ``high``; each side is at least a centimetre long."""

    low: Point
    high: Point


@record
class Region:
    """A part of a level with a name, by which reports say where something happened."""

    name: str
    box: Box
