"""Where on the map of a level the names of its places and things stand, so that each is where it belongs."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from math import hypot
from typing import Final

from tltl_runtime.regression.report.page.plan import Plan, Rect
from tltl_runtime.stealth.level import Level, Region
from tltlc.core.record import record, replace

_LETTER: Final = 25
_LINE: Final = 48
"""Width of a letter and height of a line, in centimetres on a map of usual size: they keep theirs on the screen."""

_ABOVE: Final = 35
"""Centimetres from the middle of a switch or an exit to the foot of its name."""

_MARGIN: Final = 12
"""Centimetres from the western side of a region to its name."""

_ROWS: Final = (0, -1, 2, 3, -2)
"""Lines below the place of a thing that are tried for its name; the first one would be on the thing itself."""

_STEP: Final = 50
"""Centimetres between the places that are tried for a name."""


@record
class Name:
    """A name on the map: its lines, of which the first one's foot stands at ``x`` and ``y``, in centimetres.

    ``kind`` is a class: ``region-name`` begins at ``x``, and ``thing-name`` and ``enemy-name`` have it as their middle.
    ``spoken``: a sentence on the case has the name.
    """

    lines: tuple[str, ...]
    kind: str
    x: int
    y: int
    spoken: bool = False


def names(level: Level, plan: Plan, said: str) -> Iterator[Name]:
    """The names of what is small, of the solids that the sentences ``said`` speak of, and of all regions."""
    taken: list[Rect] = []
    for thing in _things(level, plan, said):
        name = _apart(thing, taken, plan.size)
        taken.append(_around(name))
        yield name
    taken += [plan.rect(each.box) for each in level.solids if each.kind in ("wall", "low")]
    taken += [plan.rect(each.box) for each in level.barriers]
    spoken = _regions_spoken_of(level, said)
    for row, region in enumerate(level.regions):
        # A place in several regions is called by the first of them.
        others = [plan.rect(each.box) for each in level.regions[:row]]
        name = _of_region(region, plan.rect(region.box), others, taken, spoken=region.name in spoken)
        taken.append(_around(name))
        yield name


def is_spoken_of(name: str, said: str) -> bool:
    """Whether sentences speak of a thing of that name, or of its keys: ``wall.NAME.at``."""
    return re.search(rf"[`.]{re.escape(name)}[`.]", said) is not None


def _things(level: Level, plan: Plan, said: str) -> Iterator[Name]:
    """The names of things where they stand if nothing else is there."""
    small = [(each.name, plan.at(each.position)) for each in level.switches]
    small += [(each.name, plan.at(each.position)) for each in level.exits]
    wide = [(each.name, plan.middle(each.box)) for each in level.barriers]
    wide += [(each.name, plan.middle(each.box)) for each in level.solids if is_spoken_of(each.name, said)]
    wide += [(each.name, plan.at(each.path[0])) for each in level.movers if is_spoken_of(each.name, said)]
    enemies = [(each.name, plan.at(each.route[0])) for each in level.enemies]
    for things, kind, above in (
        (small, "thing-name", _ABOVE),
        (wide, "thing-name", 0),
        (enemies, "enemy-name", _ABOVE),
    ):
        for name, (x, y) in things:
            half = _LETTER * len(name) // 2
            middle = min(max(x, half), max(half, plan.size[0] - half))
            yield Name((name,), kind, middle, y - above, is_spoken_of(name, said))


def _apart(name: Name, taken: Sequence[Rect], size: tuple[int, int]) -> Name:
    """The name where no other one is on a map of that size: above or below its place, or else beside that."""
    half = _LETTER * len(name.lines[0]) // 2
    right, lowest = max(half, size[0] - half), max(_LINE, size[1])
    tried = [
        replace(
            name,
            x=min(max(half, name.x + side * half), right),
            y=min(max(_LINE, name.y + row * _LINE), lowest),
        )
        for side in (0, 1, -1, 2, -2)
        for row in _ROWS
    ]
    return min(tried, key=lambda each: sum(_common(_around(each), other) for other in taken))


def _regions_spoken_of(level: Level, said: str) -> set[str]:
    """The names of regions of which sentences speak, as *the left part*, which is not *the left*."""
    called = {each.name.replace("_", " "): each.name for each in level.regions}
    words = "|".join(map(re.escape, sorted(called, key=len, reverse=True)))
    return {called[each] for each in re.findall(rf"\bthe ({words})(?![-\w])", said)} if called else set()


def _of_region(region: Region, inside: Rect, others: Sequence[Rect], taken: Sequence[Rect], *, spoken: bool) -> Name:
    """In its region, where no other one is, and as near to its north-western corner as there is room."""
    name = region.name.replace("_", " ")
    best, least = Name((name,), "region-name", inside[0] + _MARGIN, inside[1] + _LINE, spoken), float("inf")
    # A name that is too long for a line has one for each of its words.
    lines = (name,) if _LETTER * len(name) <= inside[2] - inside[0] else tuple(name.split())
    width, height = _LETTER * max(map(len, lines)) + _MARGIN, _LINE * len(lines)
    for left in range(inside[0], max(inside[0], inside[2] - width) + 1, _STEP):
        for top in range(inside[1], max(inside[1], inside[3] - height) + 1, _STEP):
            room = (left, top, left + width, top + height)
            far = hypot(left - inside[0], top - inside[1])
            hidden = sum(_common(room, each) for each in taken) + 10 * sum(_common(room, each) for each in others)
            if (cost := far + hidden) < least:
                best, least = Name(lines, "region-name", left + _MARGIN, top + _LINE, spoken), cost
    return best


def _around(name: Name) -> Rect:
    width = _LETTER * max(map(len, name.lines))
    left = name.x if name.kind == "region-name" else name.x - width // 2
    return left, name.y - _LINE, left + width, name.y + _LINE * (len(name.lines) - 1)


def _common(one: Rect, other: Rect) -> int:
    """The area that two rectangles have in common."""
    width = min(one[2], other[2]) - max(one[0], other[0])
    height = min(one[3], other[3]) - max(one[1], other[1])
    return max(0, width) * max(0, height)
