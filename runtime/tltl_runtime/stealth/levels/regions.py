"""The regions of a level, by whose names reports say where something happened."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from tltl_runtime.stealth.level import Box, Mover, Point, Region, Solid
from tltl_runtime.stealth.levels.parts import box
from tltl_runtime.stealth.levels.table import Table


def named_regions(table: Table) -> tuple[Region, ...]:
    """Those that the level itself names, under ``[[region]]``."""
    found = []
    for item in table.tables("region"):
        found.append(Region(item.text("name"), box(item)))
        item.done()
    return tuple(found)


def part_regions(name: str, solids: Sequence[Solid], movers: Sequence[Mover]) -> Iterator[Region]:
    """The region of a part that a level uses: the least box around what it brings; none where that is nothing."""
    boxes = [solid.box for solid in solids] + [_at(mover, point) for mover in movers for point in mover.path]
    if boxes:
        lows, highs = zip(*(each.low for each in boxes), strict=True), zip(*(each.high for each in boxes), strict=True)
        (x, y, z), (east, north, top) = map(min, lows), map(max, highs)
        yield Region(name, Box((x, y, z), (east, north, top)))


def _at(mover: Mover, centre: Point) -> Box:
    (x, y, z), (dx, dy, dz) = centre, mover.size
    return Box((x - dx / 2, y - dy / 2, z - dz / 2), (x + dx / 2, y + dy / 2, z + dz / 2))
