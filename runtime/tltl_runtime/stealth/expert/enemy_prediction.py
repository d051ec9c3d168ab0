"""Predict what the enemies will do, from what a player can see of them.

There is a set of models for each enemy. A model is a simulated enemy, an object of the game's own
class, with the enemy's route and parameters but with other random numbers. After each time step,
only the models that did what the enemy did are kept, and copies of them replace the others. If no
model did, all models are moved to the enemy's pose, and new goals are guessed for them.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot, pi, remainder
from typing import Final, cast

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.stealth.enemies.enemy import EnemyGuard, EnemyMode, PlayerView
from tltl_runtime.stealth.enemies.grid import Floor, grid_of
from tltl_runtime.stealth.enemies.segments import Corners, corners
from tltl_runtime.stealth.level import StealthLevel
from tltl_runtime.stealth.snapshot import Snapshot, player_view
from tltl_runtime.stealth.world.player import DECISION
from tltlc.api import record

_MODELS: Final = 12
"""The number of models of each enemy."""
_SAME: Final = 0.02
"""A model is right if it differs from its enemy by less than this, in metres and in radians."""
_GUESSED: Final = 0.7
"""If no model was right, the probability that a patrolling model gets a new goal.

If the enemy has optional branches, it is also the probability that this goal is a narrow place.
"""
_BURIED: Final = -1000.0
"""The height of the feet of a player whom no enemy can see, in metres."""


@record
class Outlook:
    """The predictions of all models for one enemy, over some time steps ("decisions").

    ``poses`` are float64 [models, decisions, 4]: x, y, yaw, and whether the enemy knows the
    player's position (1 or 0). An enemy that knows the position sees in all directions. ``shares``
    [models] are the probabilities of the models.
    """

    poses: NDArray[np.float64]
    shares: NDArray[np.float64]


class Watch:
    """Watches the enemies of a level, to predict them. Pass the snapshot of each time step to ``see`` once."""

    def __init__(self, level: StealthLevel, seed: int = 0) -> None:
        self.level = level
        self._seed = seed
        self.reset()

    def reset(self) -> None:
        """Prepare for a new episode."""
        self._rng = np.random.default_rng(self._seed)
        self._open: tuple[bool, ...] = (False,) * len(self.level.barriers)
        self.floor = self._update_floor()
        self.models = [
            [EnemyGuard(enemy, self.floor, self._rng) for _ in range(_MODELS)] for enemy in self.level.enemies
        ]
        self._time = 0.0
        self._player = self.level.start.position

    def see(self, snapshot: Snapshot) -> bool:
        """Update the models from a snapshot; return whether there is an enemy whose models were all wrong."""
        surprised = False
        if snapshot.time > self._time:
            player = player_view(snapshot.player)
            for models in self.models:
                for model in models:
                    model.step(DECISION, player, self.boxes)
        self._time, self._player = snapshot.time, snapshot.player.position
        if snapshot.open != self._open:
            self._open = snapshot.open
            self.floor = self._update_floor()
            for model in (model for models in self.models for model in models):
                model.floor = self.floor
                model.forget_path()
        for index, models in enumerate(self.models):
            x, y, _ = snapshot.enemies[index]
            pose, mode = (x, y, snapshot.yaws[index]), cast("EnemyMode", snapshot.modes[index])
            matching = [model for model in models if _is_at(model, pose) and model.mode == mode]
            surprised |= not matching
            if not matching:
                matching = [self._put(model, pose, mode) for model in models]
            if len(matching) < _MODELS:
                self.models[index] = [matching[number % len(matching)].fork(self._rng) for number in range(_MODELS)]
        return surprised

    def outlook(self, decisions: int) -> list[Outlook]:
        """Predict each enemy of the level for the next ``decisions`` time steps, as if it saw no player."""
        x, y, _ = self._player
        unseen = PlayerView((x, y, _BURIED))
        return [self._outlook(models, decisions, unseen) for models in self.models]

    def _outlook(self, models: Sequence[EnemyGuard], decisions: int, unseen: PlayerView) -> Outlook:
        distinct: dict[tuple[object, ...], tuple[EnemyGuard, int]] = {}
        for model in models:
            # Models that draw random numbers move differently even from the same state: keep each of them. Of the
            # others, keep one for each state.
            draws = model.kind.branches or model.mode == "search"
            key = (id(model),) if draws else model.state
            first, count = distinct.get(key, (model, 0))
            distinct[key] = (first, count + 1)
        poses = np.empty((len(distinct), decisions, 4))
        for row, (model, _) in enumerate(distinct.values()):
            guard = model.fork(self._rng)
            for step in range(decisions):
                guard.step(DECISION, unseen, ())
                poses[row, step] = guard.x, guard.y, guard.yaw, guard.knows
        shares = np.array([count for _, count in distinct.values()], dtype=np.float64)
        return Outlook(poses, shares / shares.sum())

    def _put(self, model: EnemyGuard, pose: tuple[float, float, float], mode: EnemyMode) -> EnemyGuard:
        """Move a model to its enemy's ``pose``, and give it a task that fits the enemy's ``mode``.

        Return the model.
        """
        before = model.mode
        model.x, model.y, model.yaw = pose
        model.forget_path()
        if mode == before:
            if mode == "patrol" and self._rng.random() < _GUESSED:
                self._guess(model)
            return model
        model.mode = mode
        model.knows = mode == "chase"
        model.is_off_route = mode == "return"
        model.search_left = model.kind.search_time if mode == "search" else 0.0
        model.searching = False
        if mode == "return":
            model.leg = model.nearest_leg()
        elif mode == "patrol":
            self._guess(model)
        return model

    def _guess(self, model: EnemyGuard) -> None:
        """Guess where a model of a patrolling enemy goes: to a point of its route, or a narrow place off it."""
        model.leg = int(self._rng.integers(len(model.route)))
        model.gap = model.next_gap() if model.kind.branches and self._rng.random() < _GUESSED else None

    def _update_floor(self) -> Floor:
        """Return the floor that enemies can walk on now, and update the boxes that block sight."""
        level = self.level
        shut = [index for index, is_open in enumerate(self._open) if not is_open]
        self.boxes: list[Corners] = [corners(solid.box) for solid in level.solids if solid.box.high[2] > 0.0]
        self.boxes += [corners(level.barriers[index].box) for index in shut if level.barriers[index].kind == "solid"]
        return grid_of(level).floor(shut)


def _is_at(model: EnemyGuard, pose: tuple[float, float, float]) -> bool:
    x, y, yaw = pose
    return hypot(model.x - x, model.y - y) < _SAME and abs(remainder(model.yaw - yaw, 2 * pi)) < _SAME
