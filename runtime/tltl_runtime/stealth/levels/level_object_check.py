"""Check that a level can be drawn and played, even if it was not read from a level file."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltl_runtime.stealth.enemies.branches import added_branches
from tltl_runtime.stealth.enemies.grid import is_too_large
from tltl_runtime.stealth.level import Box, Point, StealthLevel
from tltl_runtime.stealth.signals import readers
from tltl_runtime.support.checked_table import FARTHEST
from tltlc.api import replace

_THINNEST: Final = 1e-3
"""The smallest side of a box, in metres."""


def fault(level: StealthLevel) -> str | None:
    """Return a description of the first fault that keeps a level from being drawn and played.

    Return None if there is no fault. Invalid names, and things without enough room, are not faults
    here: they are checked when a level file is read.
    """
    return next(_faults(level), None)


def _faults(level: StealthLevel) -> Iterator[str]:
    boxes = [("the bounds are", level.bounds)]
    boxes += [(f"the solid `{solid.name}` is", solid.box) for solid in level.solids]
    boxes += [(f"the barrier `{barrier.name}` is", barrier.box) for barrier in level.barriers]
    yield from (f"{what} not a box within {FARTHEST:g} m" for what, box in boxes if not _is_box(box))
    for mover in level.movers:
        valid = mover.path and all(map(_is_place, mover.path)) and min(mover.size) >= _THINNEST and mover.speed > 0.0
        if not valid or min(mover.pause, mover.offset) < 0.0:
            yield f"the mover `{mover.name}` has an invalid path, size, speed, pause or offset"
    if level.enemies and is_too_large(level.bounds):
        yield "the bounds are too large for enemies"
    for enemy in level.enemies:
        if not enemy.route or not all(map(_is_place, enemy.route)):
            yield f"the enemy `{enemy.name}` has no valid route"
        unknown = set(enemy.kind.branches) - set(added_branches())
        yield from (f"the enemy `{enemy.name}` has a branch `{name}`, which does not exist" for name in sorted(unknown))
    places = [level.start.position]
    places += [switch.position for switch in level.switches]
    places += [exit_.position for exit_ in level.exits]
    yield from (f"{place} is not a place within {FARTHEST:g} m" for place in places if not _is_place(place))
    yield from _wrong_references(level)


def _wrong_references(level: StealthLevel) -> Iterator[str]:
    switches, barriers = {switch.name for switch in level.switches}, {barrier.name for barrier in level.barriers}
    opening = {name for barrier in level.barriers for name in barrier.opened_by}
    opening |= {unlock.switch for unlock in level.unlocks}
    opened = {name for unlock in level.unlocks for name in unlock.barriers}
    yield from (f"there is no switch `{name}`" for name in sorted(opening - switches))
    yield from (f"there is no barrier `{name}`" for name in sorted(opened - barriers))
    yield from (f"`{unlock.switch}` unlocks nothing" for unlock in level.unlocks if not unlock.barriers)
    signals = set(readers(replace(level, signals=())))
    for alias, target in level.signals:
        if target not in signals:
            yield f"there is no signal `{target}`"
        signals.add(alias)


def _is_box(box: Box) -> bool:
    sides = [high - low for low, high in zip(box.low, box.high, strict=True)]
    return _is_place(box.low) and _is_place(box.high) and min(sides) >= _THINNEST


def _is_place(point: Point) -> bool:
    return all(abs(value) <= FARTHEST for value in point)
