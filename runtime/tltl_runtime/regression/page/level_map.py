"""The map of a level as an inline SVG: what stands there; who moves and what happened is drawn onto it by the page.

Its units are centimetres from the north-western corner of the level's bounds, x eastwards, y southwards.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import count
from math import cos, pi, sin
from typing import Any, Final

from tltl_runtime.regression.page.markup import Markup, element
from tltl_runtime.stealth.enemies.enemy import EYES
from tltl_runtime.stealth.level import Box, Level, Mover
from tltl_runtime.stealth.pictures.plan import patrol
from tltl_runtime.stealth.world.geometry import around

_MARGIN: Final = 30
_LETTER: Final = 25
_LINE: Final = 60
"""Width of a letter and height of a line of names, at most: they keep their size where the map is small."""
_LAYERS: Final = ("heat", "ways", "ends", "live")
"""What the page draws into, from below to above."""

_SIGNS: Final = {
    "start": "start",
    "switch": "switch",
    "exit": "exit",
    "barrier solid": "gate",
    "barrier laser": "laser",
    "route": "route of an enemy",
    "mover-way": "way of a moving obstacle",
    "solid platform": "platform",
    "solid low": "low obstacle",
    "solid wall": "wall",
}
"""What there is on a map, by class, and what it is called."""


def level_map(level: Level) -> Markup:
    """The map of a level with empty layers ``heat``, ``ways``, ``ends`` and ``live``."""
    plan = _Plan(level.bounds)
    width, height = plan.size
    view = f"{-_MARGIN} {-_MARGIN} {width + 2 * _MARGIN} {height + 2 * _MARGIN}"
    below = [*_ground(level, plan), element("g", class_="heat"), *_entities(level, plan)]
    above = [element("g", class_=layer) for layer in _LAYERS[1:]]
    return element(
        "svg",
        *below,
        *above[:-1],
        element("g", *_names(level, plan), class_="names"),
        above[-1],
        class_="plan map",
        viewBox=view,
        role="group",
        aria_label=f"Map of {level.name} {level.variant}",
    )


def map_key(level: Level) -> Markup:
    """What the signs of a map mean, those that there are in it."""
    solids, barriers = ({each.kind for each in entities} for entities in (level.solids, level.barriers))
    there = {
        "switch": level.switches,
        "exit": level.exits,
        "route": level.enemies,
        "mover-way": level.movers,
        **{f"barrier {kind}": kind in barriers for kind in ("solid", "laser")},
        **{f"solid {kind}": kind in solids for kind in ("platform", "low", "wall")},
    }
    rows = [element("li", _sign(kind), _SIGNS[kind]) for kind in _SIGNS if there.get(kind, True)]
    return element("ul", *rows, class_="legend signs", aria_label="Signs of the map")


def map_data(level: Level) -> dict[str, Any]:
    """What the page needs to know of a level to draw onto its map, as JSON data.

    ``blocks`` are what stops sight: sides on the map, and heights, in centimetres; ``movers`` do, too.
    ``reach`` and ``angle``, in degrees, are those of an enemy's cone of sight, ``eyes`` the height of its eyes.
    """
    plan = _Plan(level.bounds)
    return {
        "blocks": [_block(plan, solid.box) for solid in level.solids if solid.kind != "floor"],
        "barriers": [{"kind": barrier.kind, "block": _block(plan, barrier.box)} for barrier in level.barriers],
        "movers": [_mover(mover) for mover in level.movers],
        "enemies": [
            {
                "name": enemy.name,
                "reach": round(100 * enemy.kind.sight_range),
                "angle": min(360, round(enemy.kind.sight_angle * 180 / pi)),
                "eyes": round(100 * (enemy.route[0][2] + EYES)),
            }
            for enemy in level.enemies
        ],
    }


def _mover(mover: Mover) -> dict[str, list[int]]:
    """Its sides on the map, and from which height to which it stops sight, in centimetres."""
    low, high = around(mover.path[0], mover.size)
    return {
        "sides": [round(100 * side) for side in mover.size[:2]],
        "heights": [round(100 * low[2]), round(100 * high[2])],
    }


def _sign(kind: str) -> Markup:
    if kind == "exit":
        inside = element("polygon", class_=kind, points=_star(0, 0, 8.0))
    elif kind in ("switch", "start"):
        inside = element("circle", class_=kind, r=7 if kind == "switch" else 4)
    elif kind in ("route", "mover-way"):
        inside = element("polyline", class_=kind, points="-8,0 8,0")
    else:
        inside = element("rect", class_=kind, x=-8, y=-5, width=16, height=10)
    return element("svg", inside, class_="plan", viewBox="-8 -8 16 16", aria_hidden="true")


class _Plan:
    """Where on the map something is."""

    def __init__(self, bounds: Box) -> None:
        (self.west, south, _), (east, self.north, _) = bounds.low, bounds.high
        self.size = (round(100 * (east - self.west)), round(100 * (self.north - south)))

    def at(self, point: Sequence[float]) -> tuple[int, int]:
        return round(100 * (point[0] - self.west)), round(100 * (self.north - point[1]))

    def sides(self, box: Box) -> dict[str, int]:
        (left, bottom), (right, top) = self.at(box.low), self.at(box.high)
        return {"x": left, "y": top, "width": right - left, "height": bottom - top}

    def line(self, points: Iterable[Sequence[float]]) -> str:
        return " ".join(f"{x},{y}" for x, y in map(self.at, points))


def _ground(level: Level, plan: _Plan) -> Iterable[Markup]:
    for solid in sorted(level.solids, key=lambda each: each.box.high[2]):
        yield element("rect", element("title", solid.name), class_=f"solid {solid.kind}", **plan.sides(solid.box))
    for region in level.regions:
        yield element("rect", class_="region", **plan.sides(region.box))


def _entities(level: Level, plan: _Plan) -> Iterable[Markup]:
    for enemy in level.enemies:
        title = element("title", f"route of {enemy.name}")
        yield element("polyline", title, class_="route", points=plan.line(patrol(level, enemy)))
    for mover in level.movers:
        title = element("title", f"way of {mover.name}")
        yield element("polyline", title, class_="mover-way", points=plan.line(mover.path))
    for barrier in level.barriers:
        title = element("title", barrier.name)
        yield element("rect", title, class_=f"barrier {barrier.kind}", **plan.sides(barrier.box))
    for switch in level.switches:
        x, y = plan.at(switch.position)
        radius = round(100 * switch.radius)
        title = element("title", switch.name)
        yield element("circle", title, class_="switch", cx=x, cy=y, r=radius)
    for way_out in level.exits:
        title = element("title", way_out.name)
        yield element("polygon", title, class_="exit", points=_star(*plan.at(way_out.position)))
    x, y = plan.at(level.start.position)
    yield element("circle", element("title", "start"), class_="start", cx=x, cy=y, r=14)


def _names(level: Level, plan: _Plan) -> Iterable[Markup]:
    placed: list[tuple[int, int, int, int]] = []
    for region in level.regions:
        x, y = plan.at((region.box.low[0], region.box.high[1]))
        end = x + _LETTER * len(region.name)
        # Names that would run into each other stand below each other.
        taken = {line for left, right, top, line in placed if left < end and x < right and abs(y - top) < _LINE}
        line = next(each for each in count(1) if each not in taken)
        placed.append((x, end, y, line))
        words = {"dx": "0.4em", "dy": f"{1.2 * line:.1f}em"}
        yield element("text", region.name.replace("_", " "), class_="region-name", x=x, y=y, **words)
    named = [(switch.name, switch.position, 35) for switch in level.switches]
    named += [(way_out.name, way_out.position, 35) for way_out in level.exits]
    for barrier in level.barriers:
        low, high = barrier.box.low, barrier.box.high
        named.append((barrier.name, ((low[0] + high[0]) / 2, (low[1] + high[1]) / 2, low[2]), 0))
    for name, place, above in named:
        x, y = plan.at(place)
        yield element("text", name, x=x, y=y - above)


def _star(x: int, y: int, radius: float = 40.0) -> str:
    corners = []
    for corner in range(10):
        angle, length = corner * pi / 5, radius if corner % 2 == 0 else 0.4 * radius
        corners.append(f"{x + length * sin(angle):.0f},{y - length * cos(angle):.0f}")
    return " ".join(corners)


def _block(plan: _Plan, box: Box) -> list[int]:
    """Left, top, right and bottom on the map, and from which height to which, in centimetres."""
    (left, bottom), (right, top) = plan.at(box.low), plan.at(box.high)
    return [left, top, right, bottom, round(100 * box.low[2]), round(100 * box.high[2])]
