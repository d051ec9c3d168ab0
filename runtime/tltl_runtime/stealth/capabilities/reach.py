"""Which places of a level a player can reach at all: more than can be reached, never less, so that "no" is a proof.

Taken for granted of the physics and of :class:`~tltl_runtime.stealth.world.player.PlayerKind`, each rather too much
than too little (tests try some of them in the physics):

- The body is crouched all the time, 0.9 m high, and 0.25 m to each side wide, not 0.3 m.
- Ground is the top of anything, within 0.28 m of it and from 0.16 m below on: there the contact with an edge is ground.
- From ground the feet come to tops that are at most 1.27 m higher: a jump lifts them by 0.97 m in steps of 1/60 s, and
  an edge more than 0.3 m above them meets the side of the body, not its round foot, which slides up.  (A top of
  1.1 m is nearly always got onto, one of 1.2 m once in a hundred tries, one of 1.24 m never was.)
- Until the next ground, nobody is faster than a sprint, 5 m/s, whatever the stamina, and no fall takes longer than one
  at 8 m/s once it is that fast.
- Moving obstacles are in nobody's way; wherever they come, their top is ground, and they throw who stands on it as high
  as 3 m/s more than their own speed would.
- Lasers and enemies stop nobody.  Barriers are shut until their switches have been reached; where one of several
  opens at random, each does.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from math import sqrt
from typing import Final

import numpy as np

from tltl_runtime.stealth.capabilities.space import (
    Budget,
    Field,
    Space,
    SpaceBudgetError,
    SpaceGrid,
    distances,
    flood,
    span,
)
from tltl_runtime.stealth.level import Box, Level, Mover, fixed_places
from tltl_runtime.stealth.world.player import PlayerKind
from tltlc.core.record import record
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.io.limits import WORK

NEAR: Final = 1.0
"""Within so many metres of its position an entity counts as reached."""

_EDGE: Final = 0.28
"""How far beside a top one still has ground, in metres: contacts count that lead upwards by more than 30 degrees."""
_EDGE_DEPTH: Final = 0.16
"""How far below a top the feet are then."""
_TOUCH: Final = 0.02
_THROW: Final = 3.0
_PHYSICS_STEP: Final = 1 / 60
_ROUNDING: Final = 1e-5


@record
class Reach:
    """What can be reached: ``switches`` and ``barriers`` (those that open) by name, and how near one gets to what.

    ``distances`` has, in metres, the least distance from the feet to each entity that stays where it is; to those
    that move it is 0.  ``ground`` [rows, columns] are the cells, ``cell`` metres wide from ``origin`` (west, south) on,
    with anything that one can stand on; rows go north.  ``highest`` is how high the highest of it is, in metres.
    """

    switches: tuple[str, ...]
    barriers: tuple[str, ...]
    distances: Mapping[str, float]
    ground: Field
    origin: tuple[float, float]
    cell: float
    highest: float

    def reaches(self, entity: str) -> bool:
        """Whether one gets within a metre of an entity."""
        return self.distances[entity] <= NEAR


def reachable(
    level: Level, *, lift: float | None = None, without: Collection[str] = (), budget: Budget | None = None
) -> Reach:
    """Everything that a player may reach from anywhere where an episode begins.

    ``lift`` is how much higher than the ground that was left the next may be, in metres, by default
    :func:`highest_lift`; solids and barriers ``without`` are not there.

    Raises:
        TltlError: TLT0006, the level is too large or too winding to be searched.
        SpaceBudgetError: the same, where the ``budget`` is given.
    """
    if budget is not None:
        return _reachable(level, lift, without, budget)
    try:
        return _reachable(level, lift, without, Budget(WORK["cells of reachable space"]))
    except SpaceBudgetError:
        title = f"it takes too long to find out what can be reached in `{level.name}:{level.variant}`"
        help_ = "make the level smaller, or leave out barriers whose switches lie behind other barriers"
        raise TltlError([Diagnostic("TLT0006", title, help=help_)]) from None


def _reachable(level: Level, lift: float | None, without: Collection[str], budget: Budget) -> Reach:
    kind = PlayerKind()
    search = _Search(level, kind, highest_lift(kind) if lift is None else lift, without, budget)
    switches: set[str] = set()
    opened: set[str] = set()
    while True:
        space = search.spread(opened)
        now = {
            each.name
            for each in level.switches
            if search.grid.distance(space, each.position, each.radius) <= each.radius
        }
        opens = {each.name for each in level.barriers if each.opened_by and now.issuperset(each.opened_by)}
        opens |= {name for unlock in level.unlocks if unlock.switch in now for name in unlock.barriers}
        if opens == opened and now == switches:
            break
        switches, opened = now, opens
    return Reach(
        switches=tuple(each.name for each in level.switches if each.name in switches),
        barriers=tuple(each.name for each in level.barriers if each.name in opened),
        distances={
            **{name: search.grid.distance(space, place) for name, place in fixed_places(level).items()},
            **{enemy.name: 0.0 for enemy in level.enemies},
            **{mover.name: 0.0 for mover in level.movers},
        },
        ground=search.ground(),
        origin=search.grid.origin,
        cell=search.grid.cell,
        highest=search.highest(),
    )


def highest_lift(kind: PlayerKind) -> float:
    """How much higher than the ground that was left the next may be, in metres: a jump, and the round foot."""
    return highest_jump(kind) + kind.radius


def highest_jump(kind: PlayerKind) -> float:
    """How much a jump lifts the feet, in metres."""
    height, speed = 0.0, kind.jump_speed - kind.gravity * _PHYSICS_STEP
    while speed > 0.0:
        height += speed * _PHYSICS_STEP
        speed -= kind.gravity * _PHYSICS_STEP
    return height


class _Search:
    """The ground that has been reached, by its height, and the space around it."""

    def __init__(self, level: Level, kind: PlayerKind, lift: float, without: Collection[str], budget: Budget) -> None:
        self._kind, self._lift = kind, lift
        self._solids = [solid.box for solid in level.solids if solid.name not in without]
        self._barriers = {
            barrier.name: barrier.box
            for barrier in level.barriers
            if barrier.kind == "solid" and barrier.name not in without
        }
        barriers = self._barriers.values()
        tops = [_Top(box, box.high[2], box.high[2]) for box in (*self._solids, *barriers)]
        tops += [_ride(mover, kind.gravity) for mover in level.movers]
        start = level.start.position
        heights = {z for top in tops for z in (top.lowest, top.height)} | {start[2]}
        cuts = [z for height in heights for z in (height - _EDGE_DEPTH, height + _TOUCH, height + lift)]
        self.grid = SpaceGrid(level.bounds, [*self._solids, *barriers], cuts, kind, budget)
        self._tops: dict[tuple[float, float], Field] = {}
        """For the lowest and the last height of tops, the cells from which one is within reach of the foot."""
        for top in tops:
            if top.lowest < level.bounds.high[2] - _TOUCH:
                key = round(top.lowest, 6), round(top.height, 6)
                found = self._tops.setdefault(key, np.zeros(self.grid.shape[1:], dtype=np.bool_))
                found |= self.grid.over(top.box, _EDGE)
        x, y, z = start
        around = self.grid.over(Box((x, y, z), (x, y, z)), level.start.spread)
        self._ground: dict[float, Field] = {z: around}
        self._space: Space = np.zeros(self.grid.shape, dtype=np.bool_)

    def ground(self) -> Field:
        """The cells with ground that has been reached."""
        found: Field = np.logical_or.reduce(list(self._ground.values()))
        return found

    def highest(self) -> float:
        """The height of the highest ground that has been reached, in metres."""
        return max(height for height, ground in self._ground.items() if ground.any())

    def spread(self, opened: Collection[str]) -> Space:
        """The space that the feet can be in, while these barriers are open."""
        shut = [box for name, box in self._barriers.items() if name not in opened]
        free = self.grid.free([*self._solids, *shut])
        waiting = {height: ground.copy() for height, ground in self._ground.items() if ground.any()}
        while waiting:
            height, fresh = waiting.popitem()
            self._walk(free, height, fresh)
            window, flight = self._flight(free, height, fresh)
            self._space[: len(flight)][:, window[0], window[1]] |= flight
            for (lowest, top), near in self._tops.items():
                if lowest > height + self._lift + _ROUNDING:
                    continue
                self.grid.budget.spend(near.size + flight.size)
                known = self._ground.setdefault(top, np.zeros_like(near))
                met = flight[self.grid.slabs(lowest - _EDGE_DEPTH, top + _TOUCH)[: len(flight)]].any(axis=0)
                new = met & near[window] & ~known[window]
                if new.any():
                    known[window] |= new
                    waiting.setdefault(top, np.zeros_like(near))[window] |= new
        return self._space

    def _walk(self, free: Space, height: float, fresh: Field) -> None:
        """Add to ground that is ``fresh`` what is side by side with it, at the same height."""
        same = np.logical_or.reduce([near for (_, top), near in self._tops.items() if top == height] or [fresh])
        same &= free[self.grid.slabs(height - _EDGE_DEPTH, height + _TOUCH)].any(axis=0)
        fresh |= flood((same | fresh)[None], fresh[None], self.grid.budget)[0] & ~self._ground[height]
        self._ground[height] |= fresh

    def _flight(self, free: Space, height: float, ground: Field) -> tuple[tuple[slice, slice], Space]:
        """Where a jump, a leap or a fall from some ground leads: the rows and columns looked at, and the space there.

        That space has the slabs from the lowest up to the greatest height of a jump.
        """
        grid = self.grid
        times = np.array([self._time(height - low) for low in grid.lows[grid.highs <= height + self._lift + _ROUNDING]])
        leaps = self._kind.sprint_speed * times / grid.cell
        most = int(leaps[0]) + 2
        inner = span(np.any(ground, axis=1)), span(np.any(ground, axis=0))
        rows, columns = (slice(max(0, part.start - most), part.stop + most) for part in inner)
        afar = distances(ground[rows, columns], most)
        allowed = free[: len(leaps)][:, rows, columns] & (afar[None] <= leaps[:, None, None])
        seeds = np.zeros_like(allowed)
        seeds[grid.slabs(height - _EDGE_DEPTH, height + _TOUCH)[: len(leaps)]] = ground[rows, columns]
        return (rows, columns), flood(allowed, seeds, grid.budget)

    def _time(self, drop: float) -> float:
        """The longest time from ground to ``drop`` metres below it, by a jump that lifts the feet all the way up."""
        speed, gravity, fastest = sqrt(2 * self._kind.gravity * self._lift), self._kind.gravity, self._kind.fall_speed
        until_fastest = (speed + fastest) / gravity
        below = (fastest**2 - speed**2) / (2 * gravity)
        if drop <= below:
            return (speed + sqrt(max(0.0, speed**2 + 2 * gravity * drop))) / gravity
        return until_fastest + (drop - below) / fastest


@record
class _Top:
    """What one can stand on: who gets onto it at ``lowest`` or higher is taken up to ``height``."""

    box: Box
    lowest: float
    height: float


def _ride(mover: Mover, gravity: float) -> _Top:
    """A mover, all along its way."""
    lows = [min(point[axis] for point in mover.path) - mover.size[axis] / 2 for axis in range(3)]
    highs = [max(point[axis] for point in mover.path) + mover.size[axis] / 2 for axis in range(3)]
    swept = Box((lows[0], lows[1], lows[2]), (highs[0], highs[1], highs[2]))
    return _Top(swept, lows[2] + mover.size[2], highs[2] + (mover.speed + _THROW) ** 2 / (2 * gravity))
