"""The floor as a lattice of places, and the effect of each action in one time step (a decision).

A place is a point of the floor where the player fits between the things that stand there.
Neighbouring places are 0.4 m apart. An action moves the player by an exact displacement, which
usually ends between places. The cost of the rest of the route from such a point is interpolated
from the four places around the point.
"""

from __future__ import annotations

from collections.abc import Collection
from functools import lru_cache
from itertools import product
from math import hypot
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.stealth.enemies.segments import Rectangle
from tltl_runtime.stealth.level import Box, Point, StealthLevel
from tltl_runtime.stealth.world.player import DECISION, SIGN, Action, PlayerKind

_SPACING: Final = 0.4
"""The distance between neighbouring places, in metres."""
_MARGIN: Final = 0.03
"""The distance to keep from obstacles, in addition to the player's radius, in metres."""
FAR: Final = np.float32(1e6)
"""The cost of an impossible action, and of a place without a route."""

Costs = NDArray[np.float32]
"""The cost of the remaining route, in decisions; the shape is [places] unless stated otherwise."""


def _actions() -> tuple[tuple[Action, ...], NDArray[np.float64]]:
    """Return the distinct actions without a jump, and their displacements, [actions, 2] in metres."""
    kind = PlayerKind()
    actions: list[Action] = []
    displacements: list[tuple[float, float]] = []
    for crouch, sprint, speed in ((0, 0, kind.walk_speed), (0, 1, kind.sprint_speed), (1, 0, kind.crouch_speed)):
        for x, y in product(range(3), repeat=2):
            if x or y or not sprint:
                length = hypot(SIGN[x], SIGN[y]) or 1.0
                actions.append((x, y, 0, crouch, sprint))
                displacements.append((SIGN[x] / length * speed * DECISION, SIGN[y] / length * speed * DECISION))
    return tuple(actions), np.array(displacements)


ACTIONS, DISPLACEMENTS = _actions()
CROUCHED: Final = np.array([crouch == 1 for *_, crouch, _ in ACTIONS])
SPRINTS: Final = np.array([sprint == 1 for *_, sprint in ACTIONS])


@lru_cache(maxsize=64)
def lattice_of(level: StealthLevel, shut: frozenset[int]) -> Lattice:
    """Return the lattice of a level, the places on its floor where the player fits.

    The barriers with the indices ``shut`` are shut. The lattice is cached per process.
    """
    return Lattice(level, shut)


class Lattice:
    """A lattice of the places on a level's floor where the player fits.

    The barriers with the indices ``shut`` are shut. ``places`` float64 [n, 2] are the x and y of
    the places, in metres.
    """

    def __init__(self, level: StealthLevel, shut: Collection[int]) -> None:
        boxes = [solid.box for solid in level.solids] + [level.barriers[index].box for index in sorted(shut)]
        kind = PlayerKind()
        self._obstacles = (
            _grow(boxes, kind.radius + _MARGIN, kind.step_height, kind.height),
            _grow(boxes, kind.radius + _MARGIN, kind.step_height, kind.crouched_height),
        )
        (x0, y0, _), (x1, y1, _) = level.bounds.low, level.bounds.high
        self._low = np.array((x0, y0)) + _SPACING / 2
        columns, rows = int((x1 - x0) / _SPACING), int((y1 - y0) / _SPACING)
        cells = np.stack(np.meshgrid(np.arange(columns), np.arange(rows), indexing="ij"), -1).reshape(-1, 2)
        centres = self._low + cells * _SPACING
        free = ~_crosses(centres, centres, self._obstacles[1])
        self.places: NDArray[np.float64] = centres[free]
        # Three extra columns and rows at each side hold no places, for moves that leave the bounds.
        self._number = np.full((columns + 6, rows + 6), -1, dtype=np.int64)
        self._number[cells[free, 0] + 3, cells[free, 1] + 3] = np.arange(len(self.places))
        ends = self.places[None] + DISPLACEMENTS[:, None]
        self._corners, self._shares = self._interpolation(ends.reshape(-1, 2))
        shape = (len(ACTIONS), len(self.places), 4)
        count = len(self.places)
        self._corners = (self._corners.reshape(shape) + CROUCHED[:, None, None] * count).astype(np.int32)
        self._shares = self._shares.reshape(shape)
        self._forbidden = np.where(self.feasible(self.places), np.float32(0), FAR)
        self._forbidden[self._shares.sum(-1) == 0] = FAR

    def feasible(self, places: NDArray[Any]) -> NDArray[np.bool_]:
        """Return whether each action is possible at ``places`` [n, 2], as bool [actions, n].

        An action is possible if the player meets no obstacle in the next time step.
        """
        feasible = np.zeros((len(ACTIONS), len(places)), dtype=bool)
        for crouched in (0, 1):
            actions = np.flatnonzero(crouched == CROUCHED)
            starts = np.broadcast_to(places[None], (len(actions), *places.shape)).reshape(-1, 2)
            ends = (places[None] + DISPLACEMENTS[actions, None]).reshape(-1, 2)
            feasible[actions] = ~_crosses(starts, ends, self._obstacles[crouched]).reshape(len(actions), -1)
        return feasible

    def values(self, value: Costs, places: NDArray[Any]) -> Costs:
        """Interpolate ``value``, which has a number for each lattice place, at ``places`` [m, 2].

        The result is [m]. It is ``FAR`` where no place of the lattice is near.
        """
        corners, shares = self._interpolation(places)
        values: Costs = (value[corners] * shares).sum(-1)
        values[shares.sum(-1) == 0] = FAR
        return values

    def least_costs(self, standing: Costs, crouched: Costs, extra: Costs) -> Costs:
        """Return the cost of the cheapest action at each place of the lattice.

        The cost of an action is its ``extra`` [actions] plus the cost at the point where the action
        ends. The cost at a point is interpolated from ``crouched`` [places] if the action crouches,
        else from ``standing`` [places].
        """
        both = np.concatenate((standing, crouched))
        costs: Costs = np.einsum("anc,anc->an", both[self._corners], self._shares)
        costs += self._forbidden
        costs += extra[:, None]
        least: Costs = costs.min(axis=0)
        return least

    def decisions_to(self, goal: Point, within: float) -> Costs:
        """Return for each place how many time steps a walk to the goal takes.

        The walk ends at most ``within`` metres from the goal. The number is ``FAR`` where there is
        no path.
        """
        at_goal = np.hypot(*(self.places - goal[:2]).T) <= within
        decisions: Costs = np.where(at_goal, np.float32(0), FAR)
        extra = np.where(SPRINTS, FAR, np.float32(1))
        for _ in range(10_000):
            updated: Costs = np.where(
                at_goal, np.float32(0), np.minimum(decisions, self.least_costs(decisions, decisions, extra))
            )
            if np.abs(updated - decisions).max() < 0.01:
                break
            decisions = updated
        return decisions

    def _interpolation(self, ends: NDArray[Any]) -> tuple[NDArray[np.int64], Costs]:
        """Return the four lattice places around each of the points ``ends``, and their weights.

        ``ends`` is [m, 2], both results are [m, 4]. The nearer a place is, the greater is its
        weight. The weight is 0 for a place where the player does not fit.
        """
        position = (ends - self._low) / _SPACING
        base = np.floor(position).astype(np.int64)
        part = position - base
        corners = np.zeros((len(ends), 4), dtype=np.int64)
        shares = np.zeros((len(ends), 4), dtype=np.float32)
        limit = np.array(self._number.shape) - 1
        for corner, (dx, dy) in enumerate(((0, 0), (0, 1), (1, 0), (1, 1))):
            column, row = np.clip(base + np.array((dx + 3, dy + 3)), 0, limit).T
            number = self._number[column, row]
            share = (part[:, 0] if dx else 1 - part[:, 0]) * (part[:, 1] if dy else 1 - part[:, 1])
            corners[:, corner] = np.maximum(number, 0)
            shares[:, corner] = np.where(number >= 0, share, 0)
        total = shares.sum(-1, keepdims=True)
        return corners, np.where(total > 0.05, shares / np.maximum(total, 1e-9), 0).astype(np.float32)


def _grow(boxes: list[Box], grow: float, step: float, height: float) -> list[Rectangle]:
    return [
        (box.low[0] - grow, box.low[1] - grow, box.high[0] + grow, box.high[1] + grow)
        for box in boxes
        if box.low[2] < height and box.high[2] > step
    ]


def _crosses(starts: NDArray[Any], ends: NDArray[Any], rectangles: list[Rectangle]) -> NDArray[np.bool_]:
    """Return for each segment whether it passes through the inside of a rectangle.

    Segment i leads from ``starts[i]`` to ``ends[i]``; both arrays are [m, 2].
    """
    crossed: NDArray[np.bool_] = np.zeros(len(starts), dtype=bool)
    enter: Any
    leave: Any
    delta = ends - starts
    with np.errstate(divide="ignore", invalid="ignore"):
        inverse = 1.0 / np.where(delta == 0.0, 1e-12, delta)
        for x0, y0, x1, y1 in rectangles:
            enter, leave = 0.0, 1.0
            for axis, low, high in ((0, x0, x1), (1, y0, y1)):
                a, b = (low - starts[:, axis]) * inverse[:, axis], (high - starts[:, axis]) * inverse[:, axis]
                enter, leave = np.maximum(enter, np.minimum(a, b)), np.minimum(leave, np.maximum(a, b))
            crossed |= enter < leave
    return crossed
