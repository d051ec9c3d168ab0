"""The map of a level as an inline SVG: everything that does not move.

A script in the HTML page then adds trajectories and what moves. The units are centimetres from the
north-western corner of the level's bounds, x eastwards, y southwards. Functions draw the map
instead of a template, because nearly every attribute is computed.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import pairwise
from math import cos, pi, sin
from typing import Any, Final

from markupsafe import Markup

from tltl_runtime.game.geometry import Box
from tltl_runtime.game.map_picture import map_picture, sign_list
from tltl_runtime.game.map_scale import MapScale
from tltl_runtime.game.mentions import NO_MENTIONS, Mentions
from tltl_runtime.stealth.enemies.enemy import EYES
from tltl_runtime.stealth.level import Mover, StealthLevel
from tltl_runtime.stealth.map_drawing.map_names import map_labels
from tltl_runtime.stealth.rendering.plan import patrol_path
from tltl_runtime.stealth.world.geometry import box_around
from tltl_runtime.support.markup import element

_SIGNS: Final = {
    "start": "start",
    "switch": "switch",
    "exit": "exit",
    "barrier solid": "gate",
    "barrier laser": "laser",
    "route": "route of an enemy",
    "mover-path": "way of a moving obstacle",
    "solid platform": "platform",
    "solid low": "low obstacle",
    "solid wall": "wall",
    "solid mentioned": "mentioned in a reason",
}
"""The signs on a map: the CSS class of each, and its meaning in the legend."""


def level_map(level: StealthLevel, mentions: Mentions = NO_MENTIONS) -> Markup:
    """Return the map of a level as SVG. The things and regions in ``mentions`` are highlighted.

    The map has empty layers ``heat``, ``trajectories``, ``ends`` and ``live``, which the script of
    the HTML page fills.
    """
    scale = MapScale(level.bounds)
    title, ground = f"Map of {level.name} {level.variant}", _ground(level, scale, mentions)
    return map_picture(title, scale, ground, _entities(level, scale), map_labels(level, scale, mentions))


def map_key(level: StealthLevel, mentions: Mentions = NO_MENTIONS) -> Markup:
    """Return the legend of a level's map as HTML, with the signs that occur on the map."""
    solids, barriers = ({entity.kind for entity in entities} for entities in (level.solids, level.barriers))
    present = {
        "switch": level.switches,
        "exit": level.exits,
        "route": level.enemies,
        "mover-path": level.movers,
        **{f"barrier {kind}": kind in barriers for kind in ("solid", "laser")},
        **{f"solid {kind}": kind in solids for kind in ("platform", "low", "wall")},
        "solid mentioned": any(solid.name in mentions.things for solid in level.solids),
    }
    return sign_list((_sign(kind), meaning) for kind, meaning in _SIGNS.items() if present.get(kind, True))


def map_data(level: StealthLevel) -> dict[str, Any]:
    """Return the data that the page's script needs to draw onto the map of a level, as JSON data.

    ``blocks``, barriers and ``movers`` (moving boxes) may block sight. Each block is a rectangle on
    the map and two heights. ``reach`` and ``angle`` describe an enemy's cone of sight, and ``eyes``
    is the height of its eyes. Lengths are in centimetres, angles in degrees.
    """
    scale = MapScale(level.bounds)
    return {
        "blocks": [_block(scale, solid.box) for solid in level.solids if solid.kind != "floor"],
        "barriers": [{"kind": barrier.kind, "block": _block(scale, barrier.box)} for barrier in level.barriers],
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
    """Return the sides of a moving box and the heights between which it blocks sight, in centimetres."""
    low, high = box_around(mover.path[0], mover.size)
    return {
        "sides": [round(100 * side) for side in mover.size[:2]],
        "heights": [round(100 * low[2]), round(100 * high[2])],
    }


def _sign(kind: str) -> Markup:
    if kind == "exit":
        return element("polygon", class_=kind, points=_star(0, 0, 8.0))
    if kind in ("switch", "start"):
        return element("circle", class_=kind, r=7 if kind == "switch" else 4)
    if kind in ("route", "mover-path"):
        return element("polyline", class_=kind, points="-8,0 8,0")
    return element("rect", class_=kind, x=-8, y=-5, width=16, height=10)


def _ground(level: StealthLevel, scale: MapScale, mentions: Mentions) -> Iterable[Markup]:
    for solid in sorted(level.solids, key=lambda item: (item.name in mentions.things, item.box.high[2])):
        kind = f"solid {solid.kind}{' mentioned' * (solid.name in mentions.things)}"
        yield element("rect", element("title", solid.name), class_=kind, **scale.sides(solid.box))
    for region in level.regions:
        yield element("rect", class_="region", **scale.sides(region.box))


def _entities(level: StealthLevel, scale: MapScale) -> Iterable[Markup]:
    for enemy in level.enemies:
        title = element("title", f"route of {enemy.name}")
        yield element("path", title, class_="route", d=_patrol_path([*map(scale.at, patrol_path(level, enemy))]))
    for mover in level.movers:
        title = element("title", f"way of {mover.name}")
        yield element("polyline", title, class_="mover-path", points=scale.line(mover.path))
    for barrier in level.barriers:
        title = element("title", barrier.name)
        yield element("rect", title, class_=f"barrier {barrier.kind}", **scale.sides(barrier.box))
    for switch in level.switches:
        x, y = scale.at(switch.position)
        radius = round(100 * switch.radius)
        title = element("title", switch.name)
        yield element("circle", title, class_="switch", cx=x, cy=y, r=radius)
    for exit_ in level.exits:
        title = element("title", exit_.name)
        yield element("polygon", title, class_="exit", points=_star(*scale.at(exit_.position)))
    x, y = scale.at(level.start.position)
    yield element("circle", element("title", "start"), class_="start", cx=x, cy=y, r=14)


def _patrol_path(points: Sequence[tuple[int, int]]) -> str:
    """Return a patrol as an SVG path that draws each segment once.

    If a dashed segment were drawn twice, the second dashes would fill the gaps of the first.
    """
    segments: dict[frozenset[tuple[int, int]], str] = {}
    for (x, y), (to_x, to_y) in pairwise(points):
        segments.setdefault(frozenset({(x, y), (to_x, to_y)}), f"M{x},{y}L{to_x},{to_y}")
    return "".join(segments.values())


def _star(x: int, y: int, radius: float = 40.0) -> str:
    corners = []
    for corner in range(10):
        angle, length = corner * pi / 5, radius if corner % 2 == 0 else 0.4 * radius
        corners.append(f"{x + length * sin(angle):.0f},{y - length * cos(angle):.0f}")
    return " ".join(corners)


def _block(scale: MapScale, box: Box) -> list[int]:
    """Return the rectangle of a box on the map, then the heights of its bottom and top, all in centimetres."""
    return [*scale.rect(box), round(100 * box.low[2]), round(100 * box.high[2])]
