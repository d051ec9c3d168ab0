"""The named regions of a level, which reports use to say where something happened."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from tltl_runtime.stealth.level import Box, Mover, Point, Region, Solid
from tltl_runtime.stealth.levels.level_tables import box
from tltl_runtime.support.checked_table import CheckedTable


def named_regions(table: CheckedTable) -> tuple[Region, ...]:
    """Return the regions that the level's file names, under ``[[region]]``."""
    regions = []
    for item in table.tables("region"):
        regions.append(Region(item.text("name"), box(item)))
        item.report_unknown_keys()
    return tuple(regions)


def part_regions(name: str, solids: Sequence[Solid], movers: Sequence[Mover]) -> Iterator[Region]:
    """Yield one region called ``name``: the bounding box of a part's solids and of its movers' paths.

    A part is a group of solids and movers (moving boxes) that levels share. If it is empty, yield
    nothing.
    """
    boxes = [solid.box for solid in solids] + [_mover_box(mover, point) for mover in movers for point in mover.path]
    if boxes:
        lows, highs = zip(*(box.low for box in boxes), strict=True), zip(*(box.high for box in boxes), strict=True)
        (x, y, z), (east, north, top) = map(min, lows), map(max, highs)
        yield Region(name, Box((x, y, z), (east, north, top)))


def _mover_box(mover: Mover, centre: Point) -> Box:
    (x, y, z), (dx, dy, dz) = centre, mover.size
    return Box((x - dx / 2, y - dy / 2, z - dz / 2), (x + dx / 2, y + dy / 2, z + dz / 2))
