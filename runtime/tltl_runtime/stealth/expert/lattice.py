"""The floor as a lattice of places, and what each action of one decision does on it.

Places lie 0.4 m apart where a player fits between everything that stands on the floor.  An action moves by its exact
way, which ends between places: a value there is interpolated from the four around it.
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
from tltl_runtime.stealth.level import Box, Level, Point
from tltl_runtime.stealth.world.player import DECISION, SIGN, Action, PlayerKind

_SPACING: Final = 0.4
"""Metres from place to place."""
_MARGIN: Final = 0.03
"""Kept to what stops bodies, beside the player's radius."""
FAR: Final = np.float32(1e6)
"""The value of what cannot be."""

Costs = NDArray[np.float32]
"""Decisions that the rest of the way costs, [places] where nothing else is said."""


def _actions() -> tuple[tuple[Action, ...], NDArray[np.float64]]:
    """All actions without a jump that differ, and how far each moves, in metres [actions, 2]."""
    kind = PlayerKind()
    actions: list[Action] = []
    ways: list[tuple[float, float]] = []
    for crouch, sprint, speed in ((0, 0, kind.walk_speed), (0, 1, kind.sprint_speed), (1, 0, kind.crouch_speed)):
        for x, y in product(range(3), repeat=2):
            if x or y or not sprint:
                length = hypot(SIGN[x], SIGN[y]) or 1.0
                actions.append((x, y, 0, crouch, sprint))
                ways.append((SIGN[x] / length * speed * DECISION, SIGN[y] / length * speed * DECISION))
    return tuple(actions), np.array(ways)


ACTIONS, WAYS = _actions()
CROUCHED: Final = np.array([crouch == 1 for *_, crouch, _ in ACTIONS])
SPRINTS: Final = np.array([sprint == 1 for *_, sprint in ACTIONS])


@lru_cache(maxsize=64)
def lattice_of(level: Level, shut: frozenset[int]) -> Lattice:
    """The lattice of a level while the barriers with these indices are shut, made once in a process."""
    return Lattice(level, shut)


class Lattice:
    """The places of a floor.  ``places`` float64 [n, 2] are their x and y, in metres."""

    def __init__(self, level: Level, shut: Collection[int]) -> None:
        boxes = [each.box for each in level.solids] + [level.barriers[index].box for index in sorted(shut)]
        kind = PlayerKind()
        self._obstacles = (
            _grown(boxes, kind.radius + _MARGIN, kind.step_height, kind.height),
            _grown(boxes, kind.radius + _MARGIN, kind.step_height, kind.crouched_height),
        )
        (x0, y0, _), (x1, y1, _) = level.bounds.low, level.bounds.high
        self._low = np.array((x0, y0)) + _SPACING / 2
        columns, rows = int((x1 - x0) / _SPACING), int((y1 - y0) / _SPACING)
        every = np.stack(np.meshgrid(np.arange(columns), np.arange(rows), indexing="ij"), -1).reshape(-1, 2)
        centres = self._low + every * _SPACING
        free = ~_crossed(centres, centres, self._obstacles[1])
        self.places: NDArray[np.float64] = centres[free]
        # A frame of three columns and rows that belong to no place, for ways that lead out of the bounds.
        self._number = np.full((columns + 6, rows + 6), -1, dtype=np.int64)
        self._number[every[free, 0] + 3, every[free, 1] + 3] = np.arange(len(self.places))
        ends = self.places[None] + WAYS[:, None]
        self._corners, self._shares = self._between(ends.reshape(-1, 2))
        shape = (len(ACTIONS), len(self.places), 4)
        count = len(self.places)
        self._corners = (self._corners.reshape(shape) + CROUCHED[:, None, None] * count).astype(np.int32)
        self._shares = self._shares.reshape(shape)
        self._forbidden = np.where(self.feasible(self.places), np.float32(0), FAR)
        self._forbidden[self._shares.sum(-1) == 0] = FAR

    def feasible(self, places: NDArray[Any]) -> NDArray[np.bool_]:
        """Whether each action's way is free from each of the places [n, 2]: bool [actions, n]."""
        found = np.zeros((len(ACTIONS), len(places)), dtype=bool)
        for crouched in (0, 1):
            mine = np.flatnonzero(crouched == CROUCHED)
            starts = np.broadcast_to(places[None], (len(mine), *places.shape)).reshape(-1, 2)
            ends = (places[None] + WAYS[mine, None]).reshape(-1, 2)
            found[mine] = ~_crossed(starts, ends, self._obstacles[crouched]).reshape(len(mine), -1)
        return found

    def values(self, value: Costs, places: NDArray[Any]) -> Costs:
        """The value [n] that is known at the lattice's places, at any places [m, 2]; FAR where none is near."""
        corners, shares = self._between(places)
        found: Costs = (value[corners] * shares).sum(-1)
        found[shares.sum(-1) == 0] = FAR
        return found

    def best(self, standing: Costs, crouched: Costs, extra: Costs) -> Costs:
        """At each place the least of what the actions lead to: a value where they end, by stance, and ``extra``."""
        both = np.concatenate((standing, crouched))
        led: Costs = np.einsum("anc,anc->an", both[self._corners], self._shares)
        led += self._forbidden
        led += extra[:, None]
        least: Costs = led.min(axis=0)
        return least

    def way_to(self, goal: Point, within: float) -> Costs:
        """Decisions that a walk takes from each place to within a distance of the goal, FAR where there is none."""
        there = np.hypot(*(self.places - goal[:2]).T) <= within
        found: Costs = np.where(there, np.float32(0), FAR)
        extra = np.where(SPRINTS, FAR, np.float32(1))
        for _ in range(10_000):
            better: Costs = np.where(there, np.float32(0), np.minimum(found, self.best(found, found, extra)))
            if np.abs(better - found).max() < 0.01:
                break
            found = better
        return found

    def _between(self, ends: NDArray[Any]) -> tuple[NDArray[np.int64], Costs]:
        """The four places around each point [m, 2], and their shares: those that are free, by their nearness."""
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


def _grown(boxes: list[Box], grow: float, step: float, height: float) -> list[Rectangle]:
    return [
        (box.low[0] - grow, box.low[1] - grow, box.high[0] + grow, box.high[1] + grow)
        for box in boxes
        if box.low[2] < height and box.high[2] > step
    ]


def _crossed(starts: NDArray[Any], ends: NDArray[Any], rectangles: list[Rectangle]) -> NDArray[np.bool_]:
    """Whether the segments between points [m, 2] go through the inside of a rectangle."""
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
