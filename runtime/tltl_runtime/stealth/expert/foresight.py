"""What to do in the next seconds: a beam search over decisions, with the motion that they would have.

Bodies are judged on the ground, by the time that has passed and how long their way still is.  A jump and a fall are one
move, played to its end before it is judged.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import inf
from typing import Final

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.stealth.expert.motion import Floats, Motion, Poses, joined, poses_of
from tltl_runtime.stealth.expert.routes import Field
from tltl_runtime.stealth.level import Box, Point
from tltl_runtime.stealth.world.player import DECISION, Action, PlayerState
from tltlc.core.record import record

LONGEST_FALL: Final = 9
"""Decisions after which a body that still falls is given up."""
_STAMINA: Final = 0.3
"""Seconds that a full stamina is worth."""
_TOUCHED: Final = 3.0
"""Seconds that it costs to touch a moving obstacle."""
_THERE: Final = 0.1
"""Seconds from the goal that count as there."""


@record
class Move:
    """An action; a body that it takes off the ground keeps its direction for ``hold`` decisions in all."""

    action: Action
    hold: int = LONGEST_FALL


@record
class Plan:
    """Actions, and where the feet are foreseen to be after each."""

    actions: tuple[Action, ...]
    places: tuple[Point, ...]


@record
class _Bodies:
    """Bodies [n] on the ground at one time, what they are judged by beside the time, and how they came there."""

    poses: Poses
    costs: Floats
    """Seconds that what they touched is reckoned as."""
    left: Floats
    """Seconds of the way to the goal."""
    began: NDArray[np.int64]
    """The time, in decisions from now, at which their last move began."""
    parents: NDArray[np.int64]
    """Which of the bodies of that time they were."""
    moves: NDArray[np.int64]
    """Which move they made."""
    trails: Floats
    """Where the feet were after each decision of that move, [n, LONGEST_FALL, 3]."""

    def take(self, which: NDArray[np.intp]) -> _Bodies:
        """Those of some indices."""
        return _Bodies(self.poses.take(which), *(getattr(self, name)[which] for name in _COLUMNS))

    def judged(self) -> Floats:
        """Less is better, among bodies of one time."""
        return self.costs + self.left - _STAMINA * self.poses.stamina


_COLUMNS: Final = ("costs", "left", "began", "parents", "moves", "trails")


class Foresight:
    """The search for the next ``ahead`` decisions, of each of which the ``kept`` best bodies go on.

    ``movers`` are the boxes that moving obstacles sweep in each decision to come, LONGEST_FALL more than ``ahead``.
    """

    def __init__(
        self,
        motion: Motion,
        field: Field,
        moves: Sequence[Move],
        movers: Sequence[Sequence[Box]],
        ahead: int,
        kept: int,
    ) -> None:
        self._motion, self._field, self._movers = motion, field, movers
        self._moves = moves
        self._actions = np.array([move.action for move in moves], dtype=np.int64)
        self._holds = np.array([move.hold for move in moves])
        self._ahead, self._kept = ahead, kept

    def plan(self, player: PlayerState) -> Plan:
        """What to do; nothing where every move ends where there is no way on."""
        due: list[list[_Bodies]] = [[] for _ in range(self._ahead + LONGEST_FALL)]
        due[0] = [_root(player)]
        passed: dict[int, _Bodies] = {}
        best, end = inf, (0, 0)
        for time, groups in enumerate(due):
            if not groups:
                continue
            bodies = passed[time] = self._best(_merged(groups))
            judged = bodies.judged() + time * DECISION
            judged[(bodies.left > _THERE) & (time < self._ahead)] = inf
            if time and judged.size and judged.min() < best:
                best, end = float(judged.min()), (time, int(judged.argmin()))
            if time < self._ahead and bodies.left.size:
                for later, landed in self._moved(bodies, time):
                    due[time + later].append(landed)
        return self._traced(passed, *end)

    def _moved(self, bodies: _Bodies, time: int) -> list[tuple[int, _Bodies]]:
        """Every body after every move, grouped by the number of decisions that the move took."""
        count, choices = bodies.costs.size, len(self._moves)
        parents, moves = np.repeat(np.arange(count), choices), np.tile(np.arange(choices), count)
        poses, costs = bodies.poses.take(parents), bodies.costs[parents]
        trails = np.zeros((parents.size, LONGEST_FALL, 3))
        landed = []
        for step in range(LONGEST_FALL):
            actions = self._actions[moves]
            if step:
                actions = actions * (self._holds[moves] > step)[:, None]
                actions[:, 2] = 0
            poses, met = self._motion.step(poses, actions, self._movers[time + step])
            costs = costs + met * _TOUCHED
            trails[:, step] = np.stack([poses.x, poses.y, poses.z], axis=1)
            down = np.flatnonzero(poses.grounded)
            if down.size:
                here = poses.take(down)
                left = self._field.at(here.x, here.y, here.z)
                began = np.full(down.size, time)
                ends = _Bodies(here, costs[down], left, began, parents[down], moves[down], trails[down])
                landed.append((step + 1, self._best(ends.take(np.flatnonzero(np.isfinite(left))))))
            up = np.flatnonzero(~poses.grounded)
            if not up.size:
                break
            poses, costs, trails = poses.take(up), costs[up], trails[up]
            parents, moves = parents[up], moves[up]
        return landed

    def _best(self, bodies: _Bodies) -> _Bodies:
        """The best body of each quarter of a metre, and of those the best."""
        poses = bodies.poses
        order = bodies.judged().argsort(kind="stable")
        cells = np.floor(np.stack([poses.x * 4, poses.y * 4, poses.z * 4 + 0.5, poses.crouching], axis=1))[order]
        _, first = np.unique(cells, axis=0, return_index=True)
        return bodies.take(order[np.sort(first)[: self._kept]])

    def _traced(self, passed: Mapping[int, _Bodies], time: int, row: int) -> Plan:
        """What led to a body of a time."""
        actions: list[Action] = []
        places: list[Point] = []
        while time:
            bodies = passed[time]
            began, move = int(bodies.began[row]), self._moves[int(bodies.moves[row])]
            x, y, jump, crouch, sprint = move.action
            for step in reversed(range(time - began)):
                held = step < move.hold
                actions.append((x, y, jump * (step == 0), crouch, sprint) if held else (0, 0, 0, 0, 0))
                place = bodies.trails[row, step]
                places.append((float(place[0]), float(place[1]), float(place[2])))
            time, row = began, int(bodies.parents[row])
        return Plan(tuple(reversed(actions)), tuple(reversed(places)))


def _root(player: PlayerState) -> _Bodies:
    """The body from which all others come."""
    none, zero = np.array([-1]), np.zeros(1)
    return _Bodies(poses_of(player), zero, np.array([inf]), none, none, none, np.zeros((1, LONGEST_FALL, 3)))


def _merged(groups: Sequence[_Bodies]) -> _Bodies:
    poses = joined([group.poses for group in groups])
    return _Bodies(poses, *(np.concatenate([getattr(group, name) for group in groups]) for name in _COLUMNS))
