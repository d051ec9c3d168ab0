"""Warn about paths of movers (moving boxes) and enemies that are valid but probably mistakes (TLT0809)."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice, pairwise
from math import dist
from typing import Final, cast

from tltl_runtime.stealth.enemies.grid import grid_of
from tltl_runtime.stealth.enemies.segments import Corners, is_blocked
from tltl_runtime.stealth.level import Enemy, Mover, Point, StealthLevel
from tltl_runtime.stealth.levels.bounds_check import point_text
from tltl_runtime.stealth.levels.level_tables import NamedParts
from tltlc.api import Diagnostic

_EPSILON: Final = 1e-6
_MOST_WARNINGS: Final = 10
"""The most warnings about one mover or enemy."""


def check_paths(level: StealthLevel, places: NamedParts) -> tuple[Diagnostic, ...]:
    """Return warnings, TLT0809, about paths that look like mistakes:

    - Two neighbouring points of a mover's path are equal.
    - A mover passes through a solid.
    - An enemy begins where it can hit the player at once.
    - An enemy cannot reach a point of its route, at all or until a barrier opens.
    """
    warnings = [
        warning for mover in level.movers for warning in islice(_mover_warnings(mover, level, places), _MOST_WARNINGS)
    ]
    warnings += [
        warning for enemy in level.enemies for warning in islice(_enemy_warnings(enemy, level, places), _MOST_WARNINGS)
    ]
    return tuple(warnings)


def _mover_warnings(mover: Mover, level: StealthLevel, places: NamedParts) -> Iterator[Diagnostic]:
    stops = [*mover.path, mover.path[0]] if mover.closed else mover.path
    if any(dist(start, end) < _EPSILON for start, end in pairwise(stops)):
        title = f"two neighbouring points in the path of `{mover.name}` are the same"
        yield _warning(title, places, mover.name, help_="use `pause` for a rest, or move one of the points")
    for solid in level.solids:
        # The box meets the solid if its centre is inside the solid grown by half the box's size.
        grown = (
            *(a - side / 2 + _EPSILON for a, side in zip(solid.box.low, mover.size, strict=True)),
            *(b + side / 2 - _EPSILON for b, side in zip(solid.box.high, mover.size, strict=True)),
        )
        # Only the player stops a mover, so a door may slide into a wall; more often this is a mistake.
        if any(is_blocked(start, end, [cast(Corners, grown)]) for start, end in pairwise(stops)):
            help_ = "if you do not want this, shorten its `path`, or move one of them"
            yield _warning(f"`{mover.name}` runs into `{solid.name}`", places, mover.name, solid.name, help_=help_)


def _enemy_warnings(enemy: Enemy, level: StealthLevel, places: NamedParts) -> Iterator[Diagnostic]:
    distance = max(0.0, dist(enemy.route[0], level.start.position) - level.start.spread)
    if distance <= enemy.kind.attack_range:
        title = f"`{enemy.name}` begins where it can hit the player at once, {distance:.2g} m from the start"
        far = enemy.kind.attack_range + level.start.spread
        help_ = f"begin its `route` more than {far:g} m from the start"
        yield _warning(title, places, enemy.name, help_=help_)
    for point in enemy.route[1:]:
        if not _can_walk(level, enemy.route[0], point, shut=False):
            title = f"`{enemy.name}` cannot walk to {point_text(point)}"
            # On cells of 0.25 m, a way that is just as wide as the enemy, 0.7 m, is not always walkable.
            help_ = "it would walk as near as it can; leave out the point, or make a way that is 1 m wide"
            yield _warning(title, places, enemy.name, help_=help_)
        elif not _can_walk(level, enemy.route[0], point, shut=True):
            title = f"`{enemy.name}` cannot walk to {point_text(point)} until a barrier opens"
            help_ = "it walks as near as it can; if you do not want this, leave out the point"
            yield _warning(title, places, enemy.name, help_=help_)


def _can_walk(level: StealthLevel, start: Point, end: Point, *, shut: bool) -> bool:
    """Whether an enemy can walk from ``start`` to ``end``, with barriers all shut or all open."""
    floor = grid_of(level).floor(range(len(level.barriers)) if shut else ())
    stands = floor.entry(start[:2]) is not None and floor.entry(end[:2]) is not None
    return stands and floor.area(start[:2]) == floor.area(end[:2])


def _warning(title: str, places: NamedParts, *names: str, help_: str) -> Diagnostic:
    return Diagnostic("TLT0809", title, places.position_labels(*names), help_, "warning")
