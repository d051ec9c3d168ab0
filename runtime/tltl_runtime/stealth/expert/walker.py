"""A player that knows the way and fears nobody.

The way as a whole is that of :mod:`~tltl_runtime.stealth.expert.routes`; what to do in the next seconds is searched
for by :mod:`~tltl_runtime.stealth.expert.foresight`, in good time before jumps, drops and moving obstacles with more of
both.
"""

from __future__ import annotations

from itertools import product
from math import dist, hypot
from typing import Final

from tltl_runtime.stealth.expert.foresight import LONGEST_FALL, Foresight, Move, Plan
from tltl_runtime.stealth.expert.motion import Motion
from tltl_runtime.stealth.expert.movers import Clocks
from tltl_runtime.stealth.expert.routes import Field, routes_of, shut_of
from tltl_runtime.stealth.level import Box, Level, Point
from tltl_runtime.stealth.snapshot import Snapshot
from tltl_runtime.stealth.world.player import SIGN, Action, PlayerKind

STAY: Final[Action] = (0, 0, 0, 0, 0)

_DIRECTIONS: Final = tuple((x, y) for x, y in product(range(3), range(3)) if x or y)
_WALKS: Final = (STAY, *((x, y, 0, 0, sprint) for x, y in _DIRECTIONS for sprint in (0, 1)))
_CROUCHES: Final = ((0, 0, 0, 1, 0), *((x, y, 0, 1, 0) for x, y in _DIRECTIONS))
_HOLDS: Final = (2, 3, LONGEST_FALL)
"""For how many decisions a jump keeps its direction, before it falls straight down."""

_NEAR: Final = 3.0
"""A jump, a drop or a mover, so many metres ahead is reckoned with."""
_BOXES: Final = 5.0
"""Boxes within so many metres are what a body can meet while it is foreseen."""
_SHORT: Final = (8, 16)
_LONG: Final = (14, 32)
"""Decisions that are looked ahead, and bodies that are kept of each, in plain and in hard places."""
_FOLLOWED: Final = 6
"""Decisions after which the search is done anew."""
_ASTRAY: Final = 0.08
"""Metres from where it was foreseen at which a body has gone astray."""


class Walker:
    """Finds the way to a goal, whatever enemies do: ``act`` gives the next action, decision by decision."""

    def __init__(self, level: Level) -> None:
        self.level = level
        self.reset()

    def reset(self) -> None:
        """Forget the episode before."""
        self._clocks = Clocks(self.level)
        self._plan = Plan((), ())
        self._for: object = None
        self._followed = 0

    def act(self, snapshot: Snapshot, goal: Point) -> Action:
        """The next action on the way to ``goal``, or to the place nearest to it that there is a way to."""
        self._clocks.see(snapshot)
        purpose = (goal, snapshot.open)
        if purpose != self._for or self._is_played() or self._is_astray(snapshot):
            self._plan = self._search(snapshot, goal)
            self._for, self._followed = purpose, 0
        if not self._plan.actions:
            return STAY
        self._followed += 1
        return self._plan.actions[self._followed - 1]

    def _is_played(self) -> bool:
        return self._followed >= min(_FOLLOWED, len(self._plan.actions))

    def _is_astray(self, snapshot: Snapshot) -> bool:
        return dist(self._plan.places[self._followed - 1], snapshot.player.position) > _ASTRAY

    def _search(self, snapshot: Snapshot, goal: Point) -> Plan:
        here = snapshot.player.position
        shut = shut_of(snapshot)
        field = routes_of(self.level, shut).field_from(here, goal)
        boxes = [solid.box for solid in self.level.solids] + [self.level.barriers[index].box for index in sorted(shut)]
        motion = Motion(PlayerKind(), [box for box in boxes if _away(box, here) <= _BOXES])
        moves = self._moves(field, snapshot)
        ahead, kept = _LONG if len(moves) > len(_WALKS) else _SHORT
        swept = [self._clocks.swept(step) for step in range(ahead + LONGEST_FALL)]
        return Foresight(motion, field, moves, swept, ahead, kept).plan(snapshot.player)

    def _moves(self, field: Field, snapshot: Snapshot) -> list[Move]:
        """The moves to choose from in this place."""
        player = snapshot.player
        way = field.way(player.position, _NEAR)
        movers = any(_away(box, player.position) <= _NEAR for box in self._clocks.swept(0, 8))
        moves = [Move(action) for action in _WALKS]
        if movers or player.crouching or any(leg.kind == "crouch" for leg in way):
            moves += [Move(action) for action in _CROUCHES]
        # Past movers one may jump anywhere on the way, else where it asks for it.
        headings = _headings(player.position, [(movers or leg.kind in ("climb", "leap"), leg.place) for leg in way])
        for x, y in sorted(headings):
            moves += [Move((x, y, 1, 0, sprint), hold) for sprint in (0, 1) for hold in _HOLDS]
        if any(leg.kind == "drop" for leg in way) or not player.grounded:
            moves += [Move((x, y, 0, 0, 0), hold) for x, y in _DIRECTIONS for hold in (1, 2)]
        return moves


def _headings(start: Point, legs: list[tuple[bool, Point]]) -> set[tuple[int, int]]:
    """The directions, as actions, within 45 degrees of those of the legs that count."""
    found = set()
    for (counts, place), before in zip(legs, [start, *(place for _, place in legs)], strict=False):
        dx, dy = place[0] - before[0], place[1] - before[1]
        for x, y in _DIRECTIONS if counts else ():
            along = (SIGN[x] * dx + SIGN[y] * dy) / (hypot(SIGN[x], SIGN[y]) * max(hypot(dx, dy), 1e-9))
            if along > 0.7:
                found.add((x, y))
    return found


def _away(box: Box, point: Point) -> float:
    """Metres from a box to a point, seen from above."""
    return hypot(*(max(box.low[axis] - point[axis], 0.0, point[axis] - box.high[axis]) for axis in (0, 1)))
