"""What a player who watches the enemies can tell of what they will do.

A belief of some guards for each enemy: models that were seen to do what the enemy did.  They are the game's own guards
with dice of the watcher's, and start from what is known, the enemies' routes and numbers.  Where an enemy does what
none of its models did, all are put to where it is, and what they are up to is guessed anew.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot, pi, remainder
from typing import Final, cast

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.stealth.enemies.enemy import Guard, Mode, PlayerView
from tltl_runtime.stealth.enemies.grid import Floor, grid_of
from tltl_runtime.stealth.enemies.segments import Corners, corners
from tltl_runtime.stealth.level import Level
from tltl_runtime.stealth.snapshot import Snapshot, player_view
from tltl_runtime.stealth.world.player import DECISION
from tltlc.core.record import record

_MODELS: Final = 12
"""Models of each enemy."""
_SAME: Final = 0.02
"""Metres and radians by which a model and its enemy may differ."""
_GUESSED: Final = 0.7
"""The share of models that are given another guess where none was right."""
_BURIED: Final = -1000.0
"""Where a player's feet are whom nobody sees."""


@record
class Outlook:
    """How an enemy may go on: ``poses`` float64 [models, decisions, 4], each model as likely as its share.

    A pose is x, y, yaw, and 1 while the enemy knows of the player, for it sees to all sides then.
    """

    poses: NDArray[np.float64]
    shares: NDArray[np.float64]


class Watch:
    """Watches the enemies of a level from the reset of an episode on: ``see`` each snapshot, once."""

    def __init__(self, level: Level, seed: int = 0) -> None:
        self.level = level
        self._seed = seed
        self.reset()

    def reset(self) -> None:
        """Before an episode."""
        self._rng = np.random.default_rng(self._seed)
        self._open: tuple[bool, ...] = (False,) * len(self.level.barriers)
        self.floor = self._changed()
        self.models = [[Guard(enemy, self.floor, self._rng) for _ in range(_MODELS)] for enemy in self.level.enemies]
        self._time = 0.0
        self._player = self.level.start.position

    def see(self, snapshot: Snapshot) -> bool:
        """Take in what there is to see now; returns whether an enemy did what no model had foreseen."""
        surprised = False
        if snapshot.time > self._time:
            player = player_view(snapshot.player)
            for models in self.models:
                for model in models:
                    model.step(DECISION, player, self.boxes)
        self._time, self._player = snapshot.time, snapshot.player.position
        if snapshot.open != self._open:
            self._open = snapshot.open
            self.floor = self._changed()
            for model in (each for models in self.models for each in models):
                model.floor = self.floor
                model.forget_way()
        for index, models in enumerate(self.models):
            x, y, _ = snapshot.enemies[index]
            pose, mode = (x, y, snapshot.yaws[index]), cast("Mode", snapshot.modes[index])
            right = [model for model in models if _is_at(model, pose) and model.mode == mode]
            surprised |= not right
            if not right:
                right = [self._put(model, pose, mode) for model in models]
            if len(right) < _MODELS:
                self.models[index] = [right[each % len(right)].fork(self._rng) for each in range(_MODELS)]
        return surprised

    def outlook(self, decisions: int) -> list[Outlook]:
        """How each enemy may go on from now if it does not see the player from now on."""
        x, y, _ = self._player
        nobody = PlayerView((x, y, _BURIED))
        return [self._outlook(models, decisions, nobody) for models in self.models]

    def _outlook(self, models: Sequence[Guard], decisions: int, nobody: PlayerView) -> Outlook:
        different: dict[tuple[object, ...], tuple[Guard, int]] = {}
        for model in models:
            # What draws goes another way each time; of others that are in the same state one will do.
            draws = model.kind.branches or model.mode == "search"
            key = (id(model),) if draws else model.state
            first, count = different.get(key, (model, 0))
            different[key] = (first, count + 1)
        poses = np.empty((len(different), decisions, 4))
        for row, (model, _) in enumerate(different.values()):
            ahead = model.fork(self._rng)
            for step in range(decisions):
                ahead.step(DECISION, nobody, ())
                poses[row, step] = ahead.x, ahead.y, ahead.yaw, ahead.knows
        shares = np.array([count for _, count in different.values()], dtype=np.float64)
        return Outlook(poses, shares / shares.sum())

    def _put(self, model: Guard, pose: tuple[float, float, float], mode: Mode) -> Guard:
        """The model where its enemy is, up to something that fits the enemy's mode."""
        before = model.mode
        model.x, model.y, model.yaw = pose
        model.forget_way()
        if mode == before:
            if mode == "patrol" and self._rng.random() < _GUESSED:
                self._guess(model)
            return model
        model.mode = mode
        model.knows = mode == "chase"
        model.back = mode == "return"
        model.search_left = model.kind.search_time if mode == "search" else 0.0
        model.searching = False
        if mode == "return":
            model.leg = model.nearest_leg()
        elif mode == "patrol":
            self._guess(model)
        return model

    def _guess(self, model: Guard) -> None:
        """Some point of the route that it may be on its way to, or some narrow place beside it."""
        model.leg = int(self._rng.integers(len(model.route)))
        model.gap = model.next_gap() if model.kind.branches and self._rng.random() < _GUESSED else None

    def _changed(self) -> Floor:
        """The floor as it is now, and the boxes that stop sight."""
        level = self.level
        shut = [index for index, is_open in enumerate(self._open) if not is_open]
        self.boxes: list[Corners] = [corners(each.box) for each in level.solids if each.box.high[2] > 0.0]
        self.boxes += [corners(level.barriers[each].box) for each in shut if level.barriers[each].kind == "solid"]
        return grid_of(level).floor(shut)


def _is_at(model: Guard, pose: tuple[float, float, float]) -> bool:
    x, y, yaw = pose
    return hypot(model.x - x, model.y - y) < _SAME and abs(remainder(model.yaw - yaw, 2 * pi)) < _SAME
