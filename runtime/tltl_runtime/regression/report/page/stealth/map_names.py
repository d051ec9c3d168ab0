"""Place the names of regions and things on the map of a level, so that they do not overlap."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import hypot
from typing import Final

from tltl_runtime.game.geometry import Region
from tltl_runtime.regression.report.page.map_scale import MapScale, Rect
from tltl_runtime.regression.report.page.stealth.mentions import Mentions
from tltl_runtime.stealth.level import Level
from tltlc.api import record, replace

_LETTER: Final = 25
_LINE: Final = 48
"""The width of a letter and the height of a line, in centimetres, on a map of usual size.

On the screen, text keeps its size whatever the size of the map.
"""

_ABOVE: Final = 35
"""Centimetres from the centre of a switch, an exit or an enemy to the foot of its name."""

_MARGIN: Final = 12
"""Centimetres between the western side of a region and its name."""

_ROWS: Final = (0, -1, 2, 3, -2)
"""The rows that are tried for the name of a thing, in lines below its default position."""

_STEP: Final = 50
"""Centimetres between the positions that are tried for the name of a region."""


@record
class MapLabel:
    """A name on the map.

    The foot of its first line is at ``x`` and ``y``, in centimetres.  ``kind`` is a CSS class: a
    ``region-name`` starts at ``x``, a ``thing-name`` or ``enemy-name`` is centred there.  ``spoken`` says
    that the report mentions the name.
    """

    lines: tuple[str, ...]
    kind: str
    x: int
    y: int
    spoken: bool = False


def names(level: Level, plan: MapScale, mentions: Mentions) -> Iterator[MapLabel]:
    """Place the names of a level.

    Switches, exits, barriers, enemies and regions always have names.  Solids and movers have names only
    if the report ``mentions`` them.
    """
    taken: list[Rect] = []
    for thing in _things(level, plan, mentions):
        name = _apart(thing, taken, plan.size)
        taken.append(_around(name))
        yield name
    taken += [plan.rect(solid.box) for solid in level.solids if solid.kind in ("wall", "low")]
    taken += [plan.rect(barrier.box) for barrier in level.barriers]
    for row, region in enumerate(level.regions):
        # Where regions overlap, the first one gives the place its name.
        earlier_regions = [plan.rect(other.box) for other in level.regions[:row]]
        spoken = region.name in mentions.regions
        name = _of_region(region, plan.rect(region.box), earlier_regions, taken, spoken=spoken)
        taken.append(_around(name))
        yield name


def _things(level: Level, plan: MapScale, mentions: Mentions) -> Iterator[MapLabel]:
    """The names of things at their default positions."""
    small = [(switch.name, plan.at(switch.position)) for switch in level.switches]
    small += [(exit_.name, plan.at(exit_.position)) for exit_ in level.exits]
    wide = [(barrier.name, plan.middle(barrier.box)) for barrier in level.barriers]
    wide += [(solid.name, plan.middle(solid.box)) for solid in level.solids if solid.name in mentions.things]
    wide += [(mover.name, plan.at(mover.path[0])) for mover in level.movers if mover.name in mentions.things]
    enemies = [(enemy.name, plan.at(enemy.route[0])) for enemy in level.enemies]
    for things, kind, above in (
        (small, "thing-name", _ABOVE),
        (wide, "thing-name", 0),
        (enemies, "enemy-name", _ABOVE),
    ):
        for name, (x, y) in things:
            half = _LETTER * len(name) // 2
            middle = min(max(x, half), max(half, plan.size[0] - half))
            yield MapLabel((name,), kind, middle, y - above, name in mentions.things)


def _apart(name: MapLabel, taken: Sequence[Rect], size: tuple[int, int]) -> MapLabel:
    """Move a name, within a map of that size, to where it overlaps ``taken`` least.

    Positions above and below come first, then positions beside them.
    """
    half = _LETTER * len(name.lines[0]) // 2
    right, lowest = max(half, size[0] - half), max(_LINE, size[1])
    candidates = [
        replace(
            name,
            x=min(max(half, name.x + side * half), right),
            y=min(max(_LINE, name.y + row * _LINE), lowest),
        )
        for side in (0, 1, -1, 2, -2)
        for row in _ROWS
    ]
    return min(candidates, key=lambda candidate: sum(_overlap(_around(candidate), other) for other in taken))


def _of_region(
    region: Region, inside: Rect, others: Sequence[Rect], taken: Sequence[Rect], *, spoken: bool
) -> MapLabel:
    """Place the name of a region inside it, near its north-western corner, without overlaps if possible."""
    name = region.name.replace("_", " ")
    best, least = MapLabel((name,), "region-name", inside[0] + _MARGIN, inside[1] + _LINE, spoken), float("inf")
    # A name that is too long for one line gets a line for each word.
    lines = (name,) if _LETTER * len(name) <= inside[2] - inside[0] else tuple(name.split())
    width, height = _LETTER * max(map(len, lines)) + _MARGIN, _LINE * len(lines)
    for left in range(inside[0], max(inside[0], inside[2] - width) + 1, _STEP):
        for top in range(inside[1], max(inside[1], inside[3] - height) + 1, _STEP):
            room = (left, top, left + width, top + height)
            far = hypot(left - inside[0], top - inside[1])
            hidden = sum(_overlap(room, rect) for rect in taken) + 10 * sum(_overlap(room, rect) for rect in others)
            if (cost := far + hidden) < least:
                best, least = MapLabel(lines, "region-name", left + _MARGIN, top + _LINE, spoken), cost
    return best


def _around(name: MapLabel) -> Rect:
    width = _LETTER * max(map(len, name.lines))
    left = name.x if name.kind == "region-name" else name.x - width // 2
    return left, name.y - _LINE, left + width, name.y + _LINE * (len(name.lines) - 1)


def _overlap(one: Rect, other: Rect) -> int:
    """The area of the intersection of two rectangles."""
    width = min(one[2], other[2]) - max(one[0], other[0])
    height = min(one[3], other[3]) - max(one[1], other[1])
    return max(0, width) * max(0, height)
