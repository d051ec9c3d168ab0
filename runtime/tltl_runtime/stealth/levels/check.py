"""What must hold of a level as a whole: names, references, and that everything stands where it can."""

from __future__ import annotations

import re
from collections.abc import Iterable
from itertools import pairwise
from typing import Final, cast

from tltl_runtime.stealth.enemies.segments import Corners, blocked
from tltl_runtime.stealth.level import Box, Level, Point
from tltl_runtime.stealth.levels.parts import CELL_TYPES, Places
from tltl_runtime.stealth.levels.table import suggestion
from tltlc.diagnostics.diagnostic import Diagnostic, Label
from tltlc.source import SourceFile

PLAIN_SIGNALS: Final = (
    *("health", "stamina", "position.x", "position.y", "position.z", "time"),
    *("visible", "seen", "crouching", "grounded"),
)
"""The signals of every level that speak of no entity."""

_BODY_RADIUS: Final = 0.35
"""Half the width of the room that a body needs, in metres."""

_BODY_HEIGHT: Final = 1.8
_SIGNAL_OF_ENTITY: Final = re.compile(r"(distance|bearing|line_of_sight|active|open)\((\w+)\)")
_EPSILON: Final = 1e-6


def entities(level: Level) -> tuple[str, ...]:
    """What specs may speak of by name: switches, barriers, exits, enemies and movers."""
    found = [switch.name for switch in level.switches]
    found += [barrier.name for barrier in level.barriers]
    found += [exit_.name for exit_ in level.exits]
    found += [enemy.name for enemy in level.enemies]
    return (*found, *(mover.name for mover in level.movers))


def check_names(names: Iterable[str], places: Places) -> list[Diagnostic]:
    """TLT0804 for each name that a spec could not declare as an entity."""
    from tltlc.grammar.parser import parse

    found = []
    for name in names:
        good = re.fullmatch(r"[A-Za-z_]\w*", name, re.ASCII) and not parse(SourceFile("", f"entity {name}\n"))[1]
        if not good:
            help_ = "a name is one word of letters, digits and _, and no word of the language, e.g. `north_door`"
            found.append(Diagnostic("TLT0804", f"no spec could speak of `{name}`", _labels(places.names, name), help_))
    return found


def check_references(level: Level, places: Places) -> list[Diagnostic]:
    """TLT0805 for each name that stands for nothing, and for barriers that nothing or too much opens."""
    known = {
        "switch": [switch.name for switch in level.switches],
        "barrier": [barrier.name for barrier in level.barriers],
        "entity": list(entities(level)),
        "cell type": list(CELL_TYPES),
        "signal": list(PLAIN_SIGNALS),
    }
    found = []
    for kind, name, label in places.references:
        if kind == "signal" and _is_signal(name, known):
            continue
        if name not in known[kind]:
            title = f"there is no {kind} `{name}`"
            found.append(Diagnostic("TLT0805", title, (label,), suggestion(name, known[kind])))
    unlocked = [name for unlock in level.unlocks for name in unlock.barriers]
    for barrier in level.barriers:
        ways = bool(barrier.opened_by) + unlocked.count(barrier.name)
        if ways != 1:
            title = f"{'two things open' if ways else 'nothing opens'} the barrier `{barrier.name}`"
            help_ = "name its switches in `opened_by`, or the barrier in one `[[unlock]]`"
            found.append(Diagnostic("TLT0805", title, _labels(places.names, barrier.name), help_))
    return found


def _is_signal(name: str, known: dict[str, list[str]]) -> bool:
    """Whether every level with these things has a signal of that name."""
    call = _SIGNAL_OF_ENTITY.fullmatch(name)
    if call is None:
        return name in PLAIN_SIGNALS
    return call[2] in known[{"active": "switch", "open": "barrier"}.get(call[1], "entity")]


def check_room(level: Level, places: Places, start: Label) -> list[Diagnostic]:
    """TLT0806 for what is outside the bounds, TLT0807 for who or what stands inside a solid."""
    boxes = [(solid.name, solid.box) for solid in level.solids]
    boxes += [(barrier.name, barrier.box) for barrier in level.barriers]
    boxes += [(mover.name, _around(point, mover.size)) for mover in level.movers for point in mover.path]
    goals = [(switch.name, switch.position) for switch in level.switches]
    goals += [(exit_.name, exit_.position) for exit_ in level.exits]
    points = list(goals)
    points += [(enemy.name, point) for enemy in level.enemies for point in enemy.route]
    spread = level.start.spread
    spots = [(name, Box(point, point)) for name, point in points]
    found = []
    for name, box in {name: box for name, box in (*boxes, *spots) if not _inside(box, level.bounds)}.items():
        title = f"`{name}` is outside the level's bounds"
        help_ = f"it reaches from {_shown(box.low)} to {_shown(box.high)}, {_bounds(level)}"
        found.append(Diagnostic("TLT0806", title, _labels(places.spots, name), help_))
    body = _body(level.start.position, 0.3 + spread)
    if not _inside(body, level.bounds):
        help_ = f"the player takes from {_shown(body.low)} to {_shown(body.high)}, {_bounds(level)}"
        found.append(Diagnostic("TLT0806", "the start is outside the level's bounds", (start,), help_))
    stops = [(solid.name, solid.box) for solid in level.solids]
    shut = [(barrier.name, barrier.box) for barrier in level.barriers]
    for name, box in (*stops, *shut):
        if _overlap(body, box):
            help_ = "move it, or lessen its `spread`: the player is 0.6 m wide and 1.8 m high"
            title = f"the start is inside `{name}`"
            found.append(Diagnostic("TLT0807", title, (start, *_labels(places.spots, name)), help_))
    for goal, point in goals:
        for name, box in stops:
            if _overlap(_body(point, 0.01, 0.1), box):
                title = f"`{goal}` is inside `{name}`, where nobody reaches it"
                labels = _labels(places.spots, goal, name)
                found.append(Diagnostic("TLT0807", title, labels, "move one of them"))
    for enemy in level.enemies:
        for point in enemy.route:
            for name, box in stops:
                if _overlap(_body(point, _BODY_RADIUS), box):
                    title = f"`{enemy.name}` cannot walk to {_shown(point)}: `{name}` is there"
                    help_ = f"points of a route keep {_BODY_RADIUS} m away from what stands in the level"
                    found.append(Diagnostic("TLT0807", title, _labels(places.spots, enemy.name, name), help_))
    return found


def check_movers(level: Level, places: Places) -> list[Diagnostic]:
    """A warning TLT0809 for each mover and solid where its way leads through it.

    Nothing stops a mover but a player, so a door may well slide into a wall; more often it is a mistake.
    """
    found = []
    for mover in level.movers:
        stops = [*mover.path, mover.path[0]] if mover.closed else mover.path
        for solid in level.solids:
            # The box meets the solid where its centre meets the solid that is larger by half of it.
            low, high = solid.box.low, solid.box.high
            larger = (
                *(a - side / 2 + _EPSILON for a, side in zip(low, mover.size, strict=True)),
                *(b + side / 2 - _EPSILON for b, side in zip(high, mover.size, strict=True)),
            )
            if any(blocked(start, end, [cast(Corners, larger)]) for start, end in pairwise(stops)):
                title = f"`{mover.name}` runs into `{solid.name}`"
                help_ = "where that is not meant, shorten its `path`, or move one of them"
                labels = _labels(places.spots, mover.name, solid.name)
                found.append(Diagnostic("TLT0809", title, labels, help_, "warning"))
    return found


def _labels(places: dict[str, Label], *names: str) -> tuple[Label, ...]:
    return tuple(places[name] for name in names if name in places)


def _body(feet: Point, radius: float, height: float = _BODY_HEIGHT) -> Box:
    """The room that somebody takes; a little above the floor, so that standing on something is no overlap."""
    x, y, z = feet
    return Box((x - radius, y - radius, z + 0.01), (x + radius, y + radius, z + height))


def _around(centre: Point, size: Point) -> Box:
    x, y, z = centre
    dx, dy, dz = (side / 2 for side in size)
    return Box((x - dx, y - dy, z - dz), (x + dx, y + dy, z + dz))


def _inside(box: Box, bounds: Box) -> bool:
    return all(
        bounds.low[axis] - _EPSILON <= box.low[axis] and box.high[axis] <= bounds.high[axis] + _EPSILON
        for axis in range(3)
    )


def _overlap(one: Box, other: Box) -> bool:
    return all(
        one.low[axis] < other.high[axis] - _EPSILON and other.low[axis] < one.high[axis] - _EPSILON for axis in range(3)
    )


def _bounds(level: Level) -> str:
    return f"the level from {_shown(level.bounds.low)} to {_shown(level.bounds.high)}"


def _shown(point: Point) -> str:
    return f"[{', '.join(f'{value:g}' for value in point)}]"
