"""To a place on the floor, unseen.

Every few decisions the ways of the enemies are looked ahead (``watch.py``), and from the end of that time backwards it
is found what the best way on costs from each place: decisions that pass, and a price for each of them in sight.
The action is then the one that leads, by its exact way, to where the rest costs least.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, pi
from typing import Final

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.stealth.expert.lattice import ACTIONS, CROUCHED, FAR, SPRINTS, WAYS, Costs, Lattice, lattice_of
from tltl_runtime.stealth.expert.lines import Lines, lines_of
from tltl_runtime.stealth.expert.routes import shut_of
from tltl_runtime.stealth.expert.watch import Outlook, Watch
from tltl_runtime.stealth.level import Level, Point
from tltl_runtime.stealth.snapshot import Snapshot
from tltl_runtime.stealth.world.player import DECISION, Action, PlayerKind

_HORIZON: Final = 80
"""Decisions that are looked ahead."""
_REPLAN: Final = 5
"""Decisions after which the plan is made anew."""
_PRICE: Final = 12.0
"""Of a decision in sight, in decisions."""
_ARRIVED: Final = 0.8
"""Metres from a goal that count as there."""
_WIDER: Final = 0.15
"""By so much, in radians to each side, the cones of sight are taken to be wider than they are."""
_FURTHER: Final = 0.4
"""By so much, in metres, sight is taken to reach further."""
_NEAR: Final = 1.6
"""To come so near to an enemy, in metres, is as bad as to be seen."""
_EXTRA: Final = np.where(SPRINTS, np.float32(1.3), np.float32(1.0))
"""What a decision costs: stamina is worth something."""
_WAYS_KEPT: Final = 32


class Sneaker:
    """Finds its way on the floor of a level, out of sight where it can: ``act`` gives the next action."""

    def __init__(self, level: Level) -> None:
        self.level = level
        self._watch = Watch(level)
        self._angles = [min(enemy.kind.sight_angle / 2 + _WIDER, pi) for enemy in level.enemies]
        self._ranges = [enemy.kind.sight_range + _FURTHER for enemy in level.enemies]
        self._ways: dict[tuple[frozenset[int], Point], Costs] = {}
        self.reset()

    def reset(self) -> None:
        """Before an episode."""
        self._watch.reset()
        self._plan: list[tuple[Costs, Costs]] = []
        self._age = 0
        self._for: tuple[object, ...] = ()

    def act(self, snapshot: Snapshot, goal: Point) -> Action:
        """What to do next on the way to ``goal``."""
        surprised = self._watch.see(snapshot)
        shut = shut_of(snapshot)
        lattice = lattice_of(self.level, shut)
        now = (goal, shut, snapshot.modes)
        self._age += 1
        if surprised or now != self._for or self._age >= _REPLAN:
            self._plan = self._planned(lattice, lines_of(self.level, shut), self._way(lattice, shut, goal))
            self._age, self._for = 0, now
        return self._chosen(lattice, snapshot)

    def _chosen(self, lattice: Lattice, snapshot: Snapshot) -> Action:
        """The action that the plan of this age values the most, from exactly where the player is."""
        player, kind = snapshot.player, PlayerKind()
        place = np.array([player.position[:2]])
        free = lattice.feasible(place)[:, 0]
        ends = place + WAYS
        standing, crouched = self._plan[self._age]
        led = np.where(CROUCHED, lattice.values(crouched, ends), lattice.values(standing, ends)) + _EXTRA
        led[~free] += FAR
        if player.stamina < DECISION / kind.stamina_time:
            led[SPRINTS] += FAR
        return ACTIONS[int(led.argmin())]

    def _planned(self, lattice: Lattice, lines: Lines, way: Costs) -> list[tuple[Costs, Costs]]:
        """For each decision from now on what its end costs from there on, by place, standing and crouched."""
        seen = self._seen(lattice, lines, self._watch.outlook(_HORIZON))
        there = way <= 0.0
        plan: list[tuple[Costs, Costs]] = []
        rest = way
        for decision in reversed(range(_HORIZON)):
            standing, crouched = rest + seen[decision, 0], rest + seen[decision, 1]
            plan.append((standing, crouched))
            rest = np.where(there, np.float32(0), lattice.best(standing, crouched, _EXTRA))
        return plan[::-1]

    def _seen(self, lattice: Lattice, lines: Lines, outlooks: Sequence[Outlook]) -> NDArray[np.float32]:
        """The price of being at each place at the end of each decision: float32 [decisions, 2, places]."""
        price = np.zeros((_HORIZON, 2, len(lattice.places)), dtype=np.float32)
        x, y = lattice.places.T.astype(np.float32)
        for outlook, angle, reach in zip(outlooks, self._angles, self._ranges, strict=True):
            for poses, share in zip(outlook.poses, outlook.shares, strict=True):
                px, py, yaw, knows = poses.T[:, :, None].astype(np.float32)
                dx, dy = x - px, y - py
                flat = np.hypot(dx, dy)
                aside = np.where(knows > 0, np.float32(-1), np.float32(cos(angle)))
                cone = (dx * np.cos(yaw) + dy * np.sin(yaw) >= flat * aside) & (flat <= reach)
                free = np.stack([lines.seen_from(a, b) for a, b, *_ in poses])
                danger = free * cone[:, None]
                danger += (flat < _NEAR)[:, None]
                price += danger * np.float32(share * _PRICE)
        return price

    def _way(self, lattice: Lattice, shut: frozenset[int], goal: Point) -> Costs:
        """Decisions from each place to the goal, where nobody watches."""
        key = (shut, goal)
        if key not in self._ways:
            if len(self._ways) >= _WAYS_KEPT:
                self._ways.clear()
            self._ways[key] = lattice.way_to(goal, _ARRIVED)
        return self._ways[key]
