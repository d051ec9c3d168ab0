"""A player that follows the shortest route and ignores enemies.

:mod:`~tltl_runtime.stealth.expert.routes` gives the whole route;
:mod:`~tltl_runtime.stealth.expert.foresight` searches for the actions of the next seconds. Near
jumps, drops and movers, the search looks further ahead and keeps more predicted states of the
player.
"""

from __future__ import annotations

from itertools import product
from math import dist, hypot
from typing import Final

from tltl_runtime.stealth.expert.foresight import LONGEST_FALL, ActionPlan, Foresight, HeldAction
from tltl_runtime.stealth.expert.motion import Motion
from tltl_runtime.stealth.expert.movers import Clocks
from tltl_runtime.stealth.expert.routes import RouteField, routes_of, shut_barriers
from tltl_runtime.stealth.level import Box, Point, StealthLevel
from tltl_runtime.stealth.snapshot import Snapshot
from tltl_runtime.stealth.world.player import SIGN, Action, PlayerKind

STAY: Final[Action] = (0, 0, 0, 0, 0)

_DIRECTIONS: Final = tuple((x, y) for x, y in product(range(3), range(3)) if x or y)
_WALKS: Final = (STAY, *((x, y, 0, 0, sprint) for x, y in _DIRECTIONS for sprint in (0, 1)))
_CROUCHES: Final = ((0, 0, 0, 1, 0), *((x, y, 0, 1, 0) for x, y in _DIRECTIONS))
_HOLDS: Final = (2, 3, LONGEST_FALL)
"""For how many time steps a jump may keep its direction; then the player falls straight down."""

_NEAR: Final = 3.0
"""The search considers jumps, drops and movers up to this distance from the player, in metres."""
_BOXES: Final = 5.0
"""The search considers boxes up to this distance from the player, in metres."""
_SHORT: Final = (8, 16)
_LONG: Final = (14, 32)
"""The number of time steps to search ahead, and the number of predicted states to keep after each.

``_LONG`` is for places where more moves than walks are possible, ``_SHORT`` for all others.
"""
_REPLAN: Final = 6
"""The search is repeated after this many time steps."""
_ASTRAY: Final = 0.08
"""The search is repeated when the player is this far from its predicted position, in metres."""


class Walker:
    """Walks to a goal as if there were no enemies. ``act`` returns the next action."""

    def __init__(self, level: StealthLevel) -> None:
        self.level = level
        self.reset()

    def reset(self) -> None:
        """Forget the previous episode."""
        self._clocks = Clocks(self.level)
        self._plan = ActionPlan((), ())
        self._purpose: object = None
        self._age = 0

    def act(self, snapshot: Snapshot, goal: Point) -> Action:
        """Return the next action towards ``goal``, or towards the reachable place nearest to it."""
        self._clocks.see(snapshot)
        purpose = (goal, snapshot.open)
        if purpose != self._purpose or self._is_played() or self._is_astray(snapshot):
            self._plan = self._search(snapshot, goal)
            self._purpose, self._age = purpose, 0
        if not self._plan.actions:
            return STAY
        self._age += 1
        return self._plan.actions[self._age - 1]

    def _is_played(self) -> bool:
        return self._age >= min(_REPLAN, len(self._plan.actions))

    def _is_astray(self, snapshot: Snapshot) -> bool:
        return dist(self._plan.places[self._age - 1], snapshot.player.position) > _ASTRAY

    def _search(self, snapshot: Snapshot, goal: Point) -> ActionPlan:
        here = snapshot.player.position
        shut = shut_barriers(snapshot)
        field = routes_of(self.level, shut).field_from(here, goal)
        boxes = [solid.box for solid in self.level.solids] + [self.level.barriers[index].box for index in sorted(shut)]
        motion = Motion(PlayerKind(), [box for box in boxes if _horizontal_distance(box, here) <= _BOXES])
        moves = self._moves(field, snapshot)
        ahead, kept = _LONG if len(moves) > len(_WALKS) else _SHORT
        swept = [self._clocks.swept_boxes(step) for step in range(ahead + LONGEST_FALL)]
        return Foresight(motion, field, moves, swept, ahead, kept).plan(snapshot.player)

    def _moves(self, field: RouteField, snapshot: Snapshot) -> list[HeldAction]:
        """Return the moves that the search for the next actions may use on the next part of the route."""
        player = snapshot.player
        legs = field.legs(player.position, _NEAR)
        movers = any(_horizontal_distance(box, player.position) <= _NEAR for box in self._clocks.swept_boxes(0, 8))
        moves = [HeldAction(action) for action in _WALKS]
        if movers or player.crouching or any(leg.kind == "crouch" for leg in legs):
            moves += [HeldAction(action) for action in _CROUCHES]
        # Near movers, jumps are allowed everywhere on the route, else only where the route needs them.
        headings = _headings(player.position, [(movers or leg.kind in ("climb", "leap"), leg.place) for leg in legs])
        for x, y in sorted(headings):
            moves += [HeldAction((x, y, 1, 0, sprint), hold) for sprint in (0, 1) for hold in _HOLDS]
        if any(leg.kind == "drop" for leg in legs) or not player.grounded:
            moves += [HeldAction((x, y, 0, 0, 0), hold) for x, y in _DIRECTIONS for hold in (1, 2)]
        return moves


def _headings(start: Point, legs: list[tuple[bool, Point]]) -> set[tuple[int, int]]:
    """Return the directions in which a player should move on a route.

    A direction is a pair of an action's choices for x and y: 0 for none, 1 along the axis, 2
    against it. The route begins at ``start``. Each of ``legs`` is a pair: whether the leg counts,
    and the point where it ends. The result has each direction that is within 45 degrees of a leg
    that counts.
    """
    headings = set()
    for (counts, place), before in zip(legs, [start, *(place for _, place in legs)], strict=False):
        dx, dy = place[0] - before[0], place[1] - before[1]
        for x, y in _DIRECTIONS if counts else ():
            along = (SIGN[x] * dx + SIGN[y] * dy) / (hypot(SIGN[x], SIGN[y]) * max(hypot(dx, dy), 1e-9))
            if along > 0.7:
                headings.add((x, y))
    return headings


def _horizontal_distance(box: Box, point: Point) -> float:
    """Return the horizontal distance from a box to a point, in metres."""
    return hypot(*(max(box.low[axis] - point[axis], 0.0, point[axis] - box.high[axis]) for axis in (0, 1)))
