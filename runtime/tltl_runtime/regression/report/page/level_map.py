"""The map of a level as an inline SVG: what stands there; who moves and what happened is drawn onto it by the page.

Its units are centimetres from the north-western corner of the level's bounds, x eastwards, y southwards.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import pairwise
from math import cos, pi, sin
from typing import Any, Final

from tltl_runtime.regression.report.page.map_names import Name, is_spoken_of, names
from tltl_runtime.regression.report.page.markup import Markup, element
from tltl_runtime.regression.report.page.plan import Plan
from tltl_runtime.stealth.enemies.enemy import EYES
from tltl_runtime.stealth.level import Box, Level, Mover
from tltl_runtime.stealth.rendering.plan import patrol
from tltl_runtime.stealth.world.geometry import around

_MARGIN: Final = 30
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
    "solid spoken": "a reason speaks of it",
}
"""What there is on a map, by class, and what it is called."""


def level_map(level: Level, said: str = "") -> Markup:
    """The map of a level with empty layers ``heat``, ``ways``, ``ends`` and ``live``.

    What the sentences ``said`` speak of stands out.
    """
    plan = Plan(level.bounds)
    width, height = plan.size
    view = f"{-_MARGIN} {-_MARGIN} {width + 2 * _MARGIN} {height + 2 * _MARGIN}"
    below = [*_ground(level, plan, said), element("g", class_="heat"), *_entities(level, plan)]
    above = [element("g", class_=layer) for layer in _LAYERS[1:]]
    return element(
        "svg",
        *below,
        *above[:-1],
        element("g", *map(_name, names(level, plan, said)), class_="names"),
        above[-1],
        class_="plan map",
        viewBox=view,
        role="group",
        aria_label=f"Map of {level.name} {level.variant}",
    )


def map_key(level: Level, said: str = "") -> Markup:
    """What the signs of a map mean, those that there are in it."""
    solids, barriers = ({each.kind for each in entities} for entities in (level.solids, level.barriers))
    there = {
        "switch": level.switches,
        "exit": level.exits,
        "route": level.enemies,
        "mover-way": level.movers,
        **{f"barrier {kind}": kind in barriers for kind in ("solid", "laser")},
        **{f"solid {kind}": kind in solids for kind in ("platform", "low", "wall")},
        "solid spoken": any(is_spoken_of(each.name, said) for each in level.solids),
    }
    rows = [element("li", _sign(kind), _SIGNS[kind]) for kind in _SIGNS if there.get(kind, True)]
    return element("ul", *rows, class_="legend signs", aria_label="Signs of the map")


def map_data(level: Level) -> dict[str, Any]:
    """What the page needs to know of a level to draw onto its map, as JSON data.

    ``blocks`` are what stops sight: sides on the map, and heights, in centimetres; ``movers`` do, too.
    ``reach`` and ``angle``, in degrees, are those of an enemy's cone of sight, ``eyes`` the height of its eyes.
    """
    plan = Plan(level.bounds)
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


def _ground(level: Level, plan: Plan, said: str) -> Iterable[Markup]:
    for solid in sorted(level.solids, key=lambda each: (is_spoken_of(each.name, said), each.box.high[2])):
        kind = f"solid {solid.kind}{' spoken' * is_spoken_of(solid.name, said)}"
        yield element("rect", element("title", solid.name), class_=kind, **plan.sides(solid.box))
    for region in level.regions:
        yield element("rect", class_="region", **plan.sides(region.box))


def _entities(level: Level, plan: Plan) -> Iterable[Markup]:
    for enemy in level.enemies:
        title = element("title", f"route of {enemy.name}")
        yield element("path", title, class_="route", d=_there_and_back([*map(plan.at, patrol(level, enemy))]))
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


def _name(name: Name) -> Markup:
    lines = [element("tspan", line, x=name.x, dy="1.1em" if row else 0) for row, line in enumerate(name.lines)]
    return element("text", *lines, class_=f"{name.kind}{' spoken' * name.spoken}", x=name.x, y=name.y)


def _there_and_back(way: Sequence[tuple[int, int]]) -> str:
    """A way round as a path that goes each of its stretches once: dashes on dashes would fill their gaps."""
    found: dict[frozenset[tuple[int, int]], str] = {}
    for (x, y), (to_x, to_y) in pairwise(way):
        found.setdefault(frozenset({(x, y), (to_x, to_y)}), f"M{x},{y}L{to_x},{to_y}")
    return "".join(found.values())


def _star(x: int, y: int, radius: float = 40.0) -> str:
    corners = []
    for corner in range(10):
        angle, length = corner * pi / 5, radius if corner % 2 == 0 else 0.4 * radius
        corners.append(f"{x + length * sin(angle):.0f},{y - length * cos(angle):.0f}")
    return " ".join(corners)


def _block(plan: Plan, box: Box) -> list[int]:
    """Its rectangle on the map, and from which height to which it is, in centimetres."""
    return [*plan.rect(box), round(100 * box.low[2]), round(100 * box.high[2])]
