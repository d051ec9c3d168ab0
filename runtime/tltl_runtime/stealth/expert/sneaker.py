"""Walk to a place on the floor, unseen.

Every few decisions (time steps), :mod:`~tltl_runtime.stealth.expert.enemy_prediction` predicts the
poses of the enemies. Dynamic programming, backwards from the end of the predicted time, then gives
the cost of the best route from each place. This cost is the number of decisions, plus a price for
each decision in sight of an enemy. The player takes the action whose exact displacement leads to
the least remaining cost.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, pi
from typing import Final

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.stealth.expert.enemy_prediction import Outlook, Watch
from tltl_runtime.stealth.expert.lattice import (
    ACTIONS,
    CROUCHED,
    DISPLACEMENTS,
    FAR,
    SPRINTS,
    Costs,
    Lattice,
    lattice_of,
)
from tltl_runtime.stealth.expert.lines import LinesOfSight, lines_of
from tltl_runtime.stealth.expert.routes import shut_barriers
from tltl_runtime.stealth.level import Point, StealthLevel
from tltl_runtime.stealth.snapshot import Snapshot
from tltl_runtime.stealth.world.player import DECISION, Action, PlayerKind

_HORIZON: Final = 80
"""The number of decisions (time steps) for which the enemies are predicted."""
_REPLAN: Final = 5
"""The plan is computed again after this many decisions."""
_PRICE: Final = 12.0
"""A decision in sight of an enemy costs as much as this many further decisions."""
_ARRIVED: Final = 0.8
"""A place within this distance of a goal counts as the goal, in metres."""
_WIDER: Final = 0.15
"""The cones of sight are widened by this, in radians to each side, as a safety margin."""
_FURTHER: Final = 0.4
"""The range of sight is lengthened by this, in metres, as a safety margin."""
_NEAR: Final = 1.6
"""Being within this distance of an enemy, in metres, is as bad as being seen."""
_EXTRA: Final = np.where(SPRINTS, np.float32(1.3), np.float32(1.0))
"""The cost of a decision with each action: sprinting costs more, because it uses stamina."""
_MOST_CACHED: Final = 32


class Sneaker:
    """Walks on the floor of a level, unseen where possible; ``act`` returns the next action."""

    def __init__(self, level: StealthLevel) -> None:
        self.level = level
        self._watch = Watch(level)
        self._angles = [min(enemy.kind.sight_angle / 2 + _WIDER, pi) for enemy in level.enemies]
        self._ranges = [enemy.kind.sight_range + _FURTHER for enemy in level.enemies]
        self._decisions_to_goals: dict[tuple[frozenset[int], Point], Costs] = {}
        self.reset()

    def reset(self) -> None:
        """Prepare for a new episode."""
        self._watch.reset()
        self._plan: list[tuple[Costs, Costs]] = []
        self._age = 0
        self._situation: tuple[object, ...] = ()

    def act(self, snapshot: Snapshot, goal: Point) -> Action:
        """Return the next action on the way to ``goal``."""
        surprised = self._watch.see(snapshot)
        shut = shut_barriers(snapshot)
        lattice = lattice_of(self.level, shut)
        situation = (goal, shut, snapshot.modes)
        self._age += 1
        if surprised or situation != self._situation or self._age >= _REPLAN:
            self._plan = self._make_plan(lattice, lines_of(self.level, shut), self._decisions_to(lattice, shut, goal))
            self._age, self._situation = 0, situation
        return self._choose(lattice, snapshot)

    def _choose(self, lattice: Lattice, snapshot: Snapshot) -> Action:
        """Return the best action at the player's exact position, by the costs in the current plan."""
        player, kind = snapshot.player, PlayerKind()
        place = np.array([player.position[:2]])
        free = lattice.feasible(place)[:, 0]
        ends = place + DISPLACEMENTS
        standing, crouched = self._plan[self._age]
        costs = np.where(CROUCHED, lattice.values(crouched, ends), lattice.values(standing, ends)) + _EXTRA
        costs[~free] += FAR
        if player.stamina < DECISION / kind.stamina_time:
            costs[SPRINTS] += FAR
        return ACTIONS[int(costs.argmin())]

    def _make_plan(self, lattice: Lattice, lines: LinesOfSight, decisions: Costs) -> list[tuple[Costs, Costs]]:
        """Return a plan: for each time step, the costs of standing and of crouching at each place.

        A cost has two parts: the price of being seen at the place at the end of the time step, and
        the cost of the rest of the route. ``decisions`` is the number of time steps that the route
        from each place would take without enemies.
        """
        seen = self._sight_prices(lattice, lines, self._watch.outlook(_HORIZON))
        at_goal = decisions <= 0.0
        plan: list[tuple[Costs, Costs]] = []
        rest = decisions
        for decision in reversed(range(_HORIZON)):
            standing, crouched = rest + seen[decision, 0], rest + seen[decision, 1]
            plan.append((standing, crouched))
            rest = np.where(at_goal, np.float32(0), lattice.least_costs(standing, crouched, _EXTRA))
        return plan[::-1]

    def _sight_prices(self, lattice: Lattice, lines: LinesOfSight, outlooks: Sequence[Outlook]) -> NDArray[np.float32]:
        """Return the price of the risk of being seen at each place, at the end of each predicted time step.

        The result is float32 [steps, 2, places], for a standing and for a crouched player.
        """
        price = np.zeros((_HORIZON, 2, len(lattice.places)), dtype=np.float32)
        x, y = lattice.places.T.astype(np.float32)
        for outlook, angle, reach in zip(outlooks, self._angles, self._ranges, strict=True):
            for poses, share in zip(outlook.poses, outlook.shares, strict=True):
                px, py, yaw, knows = poses.T[:, :, None].astype(np.float32)
                dx, dy = x - px, y - py
                distance = np.hypot(dx, dy)
                least_cosine = np.where(knows > 0, np.float32(-1), np.float32(cos(angle)))
                cone = (dx * np.cos(yaw) + dy * np.sin(yaw) >= distance * least_cosine) & (distance <= reach)
                free = np.stack([lines.visible_shares(a, b) for a, b, *_ in poses])
                danger = free * cone[:, None]
                danger += (distance < _NEAR)[:, None]
                price += danger * np.float32(share * _PRICE)
        return price

    def _decisions_to(self, lattice: Lattice, shut: frozenset[int], goal: Point) -> Costs:
        """Return how many time steps a walk from each place to the goal takes, ignoring enemies."""
        key = (shut, goal)
        if key not in self._decisions_to_goals:
            if len(self._decisions_to_goals) >= _MOST_CACHED:
                self._decisions_to_goals.clear()
            self._decisions_to_goals[key] = lattice.decisions_to(goal, _ARRIVED)
        return self._decisions_to_goals[key]
