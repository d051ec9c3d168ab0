"""Compute which places of a level a player can reach.

The result may contain places that no player reaches, but it misses none that a player reaches. So
"unreachable" is a proof. These assumptions about the physics and
:class:`~tltl_runtime.stealth.world.player.PlayerKind` err on the side of reaching too much (tests
check some of them in the physics):

- The player's body is always crouched, 0.9 m high, and extends 0.25 m to each side, not 0.3 m.
- The top of any box is ground. So is the space up to 0.28 m beside the top and 0.16 m below it,
  where contact with the edge of the box counts as ground.
- From ground, the feet can get to tops that are at most 1.27 m higher. A jump lifts the feet by
  0.97 m, computed in steps of 1/60 s. The round end of the body then slides up the last 0.3 m of an
  edge; a higher edge hits the side of the body. (In tests, the player reaches a top of 1.1 m nearly
  always, a top of 1.2 m in one of a hundred tries, and a top of 1.24 m never.)
- In the air, the player moves at most at the speed of a sprint, 5 m/s, whatever the stamina. A fall
  gets no faster than 8 m/s, so it lasts longer than in the physics.
- Movers, boxes that move along a path, block nothing. The top of a mover is ground along its whole
  path. A mover throws a player who stands on it upwards with the mover's speed plus 3 m/s.
- Lasers and enemies stop nobody. Barriers are shut until their switches have been reached. If a
  switch opens one of several barriers at random, it opens all of them here.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from math import sqrt
from typing import Final

import numpy as np

from tltl_runtime.stealth.capabilities.space import (
    Budget,
    CellMask,
    Space,
    SpaceBudgetError,
    SpaceGrid,
    distances,
    flood,
    span,
)
from tltl_runtime.stealth.level import Box, Mover, StealthLevel, fixed_places
from tltl_runtime.stealth.world.player import PlayerKind
from tltlc.api import Diagnostic, TltlError, fileio, record

NEAR: Final = 1.0
"""An entity counts as reached within this distance of its position, in metres."""

_EDGE: Final = 0.28
"""The distance to which the ground extends beside the top of a box, in metres.

It follows from the physics: contact with an edge counts as ground if its normal points upwards by
more than 30 degrees.
"""
_EDGE_DEPTH: Final = 0.16
"""The feet may be this far below the top of a box while the body touches the top's edge, in metres."""
_TOUCH: Final = 0.02
_THROW: Final = 3.0
_PHYSICS_STEP: Final = 1 / 60
_ROUNDING: Final = 1e-5


@record
class Reach:
    """The reachable part of a level.

    - ``switches``: the switches that can be reached.
    - ``barriers``: the barriers that these switches open.
    - ``distances``: by entity, the least distance from the player's feet to the entity, in metres;
      0 for enemies and movers.
    - ``ground`` [rows, columns]: a mask of the cells in which the player can stand. Cells are
      squares of the ground plan, ``cell`` metres wide, and start at ``origin`` (west, south). Rows
      go north.
    - ``highest``: the height of the highest ground that can be reached, in metres.
    """

    switches: tuple[str, ...]
    barriers: tuple[str, ...]
    distances: Mapping[str, float]
    ground: CellMask
    origin: tuple[float, float]
    cell: float
    highest: float

    def reaches(self, entity: str) -> bool:
        """Whether the player can get within :data:`NEAR`, a metre, of an entity."""
        return self.distances[entity] <= NEAR


def compute_reach(
    level: StealthLevel, *, lift: float | None = None, without: Collection[str] = (), budget: Budget | None = None
) -> Reach:
    """Compute everything that a player may reach from any start of an episode.

    ``lift`` says how much higher the player can get in one jump, in metres, by default
    :func:`highest_lift`. ``without`` names solids and barriers that are removed before the search.
    ``budget`` limits how much space the search examines.

    Raises:
        TltlError: TLT0006, ``budget`` is None, and the level is too large or too complex to search.
        SpaceBudgetError: the search exceeds ``budget``.
    """
    if budget is not None:
        return _compute_reach(level, lift, without, budget)
    try:
        return _compute_reach(level, lift, without, Budget(fileio.limits.WORK["cells of reachable space"]))
    except SpaceBudgetError:
        title = f"it takes too long to find out what can be reached in `{level.name}:{level.variant}`"
        help_ = "make the level smaller, or leave out barriers whose switches are behind other barriers"
        raise TltlError([Diagnostic("TLT0006", title, help=help_)]) from None


def _compute_reach(level: StealthLevel, lift: float | None, without: Collection[str], budget: Budget) -> Reach:
    kind = PlayerKind()
    search = _Search(level, kind, highest_lift(kind) if lift is None else lift, without, budget)
    switches: set[str] = set()
    opened: set[str] = set()
    while True:
        space = search.spread(opened)
        reached = {
            switch.name
            for switch in level.switches
            if search.grid.distance(space, switch.position, switch.radius) <= switch.radius
        }
        opening = {
            barrier.name for barrier in level.barriers if barrier.opened_by and reached.issuperset(barrier.opened_by)
        }
        opening |= {name for unlock in level.unlocks if unlock.switch in reached for name in unlock.barriers}
        if opening == opened and reached == switches:
            break
        switches, opened = reached, opening
    return Reach(
        switches=tuple(switch.name for switch in level.switches if switch.name in switches),
        barriers=tuple(barrier.name for barrier in level.barriers if barrier.name in opened),
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
    """Return how much higher than the present ground a player can get in one jump, in metres.

    The result is the height of the jump plus the radius of the player's body. The body is a
    capsule, whose round lower end slides up an edge.
    """
    return highest_jump(kind) + kind.radius


def highest_jump(kind: PlayerKind) -> float:
    """Return how far a jump lifts the feet, in metres."""
    height, speed = 0.0, kind.jump_speed - kind.gravity * _PHYSICS_STEP
    while speed > 0.0:
        height += speed * _PHYSICS_STEP
        speed -= kind.gravity * _PHYSICS_STEP
    return height


class _Search:
    """A search for all places of a level that a player can reach.

    Its state has two parts: the ground reached so far, as a mask of cells for each height, and the
    space in which the player's feet can be.
    """

    def __init__(
        self, level: StealthLevel, kind: PlayerKind, lift: float, without: Collection[str], budget: Budget
    ) -> None:
        self._kind, self._lift = kind, lift
        self._solids = [solid.box for solid in level.solids if solid.name not in without]
        self._barriers = {
            barrier.name: barrier.box
            for barrier in level.barriers
            if barrier.kind == "solid" and barrier.name not in without
        }
        barriers = self._barriers.values()
        tops = [_Top(box, box.high[2], box.high[2]) for box in (*self._solids, *barriers)]
        tops += [_mover_top(mover, kind.gravity) for mover in level.movers]
        start = level.start.position
        heights = {z for top in tops for z in (top.lowest, top.height)} | {start[2]}
        cuts = [z for height in heights for z in (height - _EDGE_DEPTH, height + _TOUCH, height + lift)]
        self.grid = SpaceGrid(level.bounds, [*self._solids, *barriers], cuts, kind, budget)
        self._tops: dict[tuple[float, float], CellMask] = {}
        """The cells from which the feet can touch a top, by its ``lowest`` and its ``height``."""
        for top in tops:
            if top.lowest < level.bounds.high[2] - _TOUCH:
                key = round(top.lowest, 6), round(top.height, 6)
                near = self._tops.setdefault(key, np.zeros(self.grid.shape[1:], dtype=np.bool_))
                near |= self.grid.cells_near(top.box, _EDGE)
        x, y, z = start
        around = self.grid.cells_near(Box((x, y, z), (x, y, z)), level.start.spread)
        self._ground: dict[float, CellMask] = {z: around}
        self._space: Space = np.zeros(self.grid.shape, dtype=np.bool_)

    def ground(self) -> CellMask:
        """Return a mask of the cells in which the search has reached ground at any height."""
        ground: CellMask = np.logical_or.reduce(list(self._ground.values()))
        return ground

    def highest(self) -> float:
        """Return the height of the highest reached ground, in metres."""
        return max(height for height, ground in self._ground.items() if ground.any())

    def spread(self, opened: Collection[str]) -> Space:
        """Extend the reached ground as far as possible while the barriers named in ``opened`` are open.

        Return the space in which the player's feet can be.
        """
        shut = [box for name, box in self._barriers.items() if name not in opened]
        free = self.grid.free_space([*self._solids, *shut])
        pending = {height: ground.copy() for height, ground in self._ground.items() if ground.any()}
        while pending:
            height, fresh = pending.popitem()
            self._walk(free, height, fresh)
            window, flight = self._flight(free, height, fresh)
            self._space[: len(flight)][:, window[0], window[1]] |= flight
            for (lowest, top), near in self._tops.items():
                if lowest > height + self._lift + _ROUNDING:
                    continue
                self.grid.budget.spend(near.size + flight.size)
                known = self._ground.setdefault(top, np.zeros_like(near))
                touched = flight[self.grid.slabs(lowest - _EDGE_DEPTH, top + _TOUCH)[: len(flight)]].any(axis=0)
                new = touched & near[window] & ~known[window]
                if new.any():
                    known[window] |= new
                    pending.setdefault(top, np.zeros_like(near))[window] |= new
        return self._space

    def _walk(self, free: Space, height: float, fresh: CellMask) -> None:
        """Add to ``fresh`` all further ground that can be walked to from it.

        ``fresh`` is a mask of cells of newly reached ground; it is modified in place. All this
        ground is at ``height``.
        """
        same = np.logical_or.reduce([near for (_, top), near in self._tops.items() if top == height] or [fresh])
        same &= free[self.grid.slabs(height - _EDGE_DEPTH, height + _TOUCH)].any(axis=0)
        fresh |= flood((same | fresh)[None], fresh[None], self.grid.budget)[0] & ~self._ground[height]
        self._ground[height] |= fresh

    def _flight(self, free: Space, height: float, ground: CellMask) -> tuple[tuple[slice, slice], Space]:
        """Return the part of ``free`` that a jump or a fall from ``ground`` at ``height`` can reach.

        The result is a window of rows and columns, and a mask of the space in this window. The
        first axis of the mask is the height, in slabs (intervals of heights): from the lowest slab
        up to the greatest height of a jump.
        """
        grid = self.grid
        times = np.array([self._time(height - low) for low in grid.lows[grid.highs <= height + self._lift + _ROUNDING]])
        leaps = self._kind.sprint_speed * times / grid.cell
        max_leap = int(leaps[0]) + 2
        inner = span(np.any(ground, axis=1)), span(np.any(ground, axis=0))
        rows, columns = (slice(max(0, part.start - max_leap), part.stop + max_leap) for part in inner)
        cells_away = distances(ground[rows, columns], max_leap)
        allowed = free[: len(leaps)][:, rows, columns] & (cells_away[None] <= leaps[:, None, None])
        seeds = np.zeros_like(allowed)
        seeds[grid.slabs(height - _EDGE_DEPTH, height + _TOUCH)[: len(leaps)]] = ground[rows, columns]
        return (rows, columns), flood(allowed, seeds, grid.budget)

    def _time(self, drop: float) -> float:
        """Return the longest time, in seconds, of a jump that ends ``drop`` metres below its start.

        The jump first lifts the feet by this search's ``lift``.
        """
        speed, gravity, fastest = sqrt(2 * self._kind.gravity * self._lift), self._kind.gravity, self._kind.fall_speed
        until_fastest = (speed + fastest) / gravity
        below = (fastest**2 - speed**2) / (2 * gravity)
        if drop <= below:
            return (speed + sqrt(max(0.0, speed**2 + 2 * gravity * drop))) / gravity
        return until_fastest + (drop - below) / fastest


@record
class _Top:
    """The top of a box, on which a player can stand.

    If the box is a mover, it carries or throws a player from ``lowest`` up to ``height``. For other
    boxes, both numbers are the height of the top.
    """

    box: Box
    lowest: float
    height: float


def _mover_top(mover: Mover, gravity: float) -> _Top:
    """Return where a player can stand on a mover (a moving box), over all its positions on its path.

    ``gravity`` limits how high the mover throws the player.
    """
    lows = [min(point[axis] for point in mover.path) - mover.size[axis] / 2 for axis in range(3)]
    highs = [max(point[axis] for point in mover.path) + mover.size[axis] / 2 for axis in range(3)]
    swept = Box((lows[0], lows[1], lows[2]), (highs[0], highs[1], highs[2]))
    return _Top(swept, lows[2] + mover.size[2], highs[2] + (mover.speed + _THROW) ** 2 / (2 * gravity))
