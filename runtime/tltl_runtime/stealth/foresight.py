"""What to do in the next seconds: a beam search over decisions, with the motion that they would have.

Bodies are judged on the ground, by the time that has passed and how long their way still is.  A jump and a fall are one
move, played to its end before it is judged.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.stealth.level import Box, Point
from tltl_runtime.stealth.motion import Floats, Motion, Poses, joined, poses_of
from tltl_runtime.stealth.player import DECISION, Action, PlayerState
from tltl_runtime.stealth.routes import Field
from tltlc.record import record

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
    """Bodies on the ground at one time, how they came there, and the seconds they are judged by beside the time."""

    poses: Poses
    parents: NDArray[np.int64]
    moves: NDArray[np.int64]
    costs: Floats
    left: Floats
    trails: Floats
    """[n, LONGEST_FALL + 1, 3]: where the feet were after each decision of the last move."""

    def take(self, which: NDArray[np.intp]) -> _Bodies:
        return _Bodies(self.poses.take(which), *(getattr(self, name)[which] for name in _OTHERS))


_OTHERS: Final = ("parents", "moves", "costs", "left", "trails")


class Foresight:
    """The search for the next ``ahead`` decisions, of each of which the ``kept`` best bodies go on.

    ``movers`` are the boxes that moving obstacles sweep in each decision to come.
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
        start = poses_of(player)
        none = np.zeros(1)
        trail = np.zeros((1, LONGEST_FALL + 1, 3))
        due: list[list[_Bodies]] = [[] for _ in range(self._ahead + LONGEST_FALL + 2)]
        due[0] = [_Bodies(start, np.array([-1]), np.array([-1]), none, none, trail)]
        best: tuple[float, int, int] | None = None
        taken: dict[int, _Bodies] = {}
        for time, groups in enumerate(due):
            if not groups:
                continue
            bodies = self._thinned(_merged(groups))
            taken[time] = bodies
            judged = bodies.costs + bodies.left - _STAMINA * bodies.poses.stamina + time * DECISION
            ends = np.flatnonzero((bodies.left < _THERE) | (time >= self._ahead)) if time else np.array([], dtype=int)
            if ends.size:
                row = int(ends[judged[ends].argmin()])
                if best is None or judged[row] < best[0]:
                    best = (float(judged[row]), time, row)
            if time < self._ahead:
                for later, landed in self._moved(bodies, time):
                    due[time + later].append(landed)
        return self._traced(taken, best)

    def _moved(self, bodies: _Bodies, time: int) -> list[tuple[int, _Bodies]]:
        """Every body after every move, grouped by the number of decisions that the move took."""
        count, choices = bodies.costs.size, len(self._moves)
        parents, moves = np.repeat(np.arange(count), choices), np.tile(np.arange(choices), count)
        poses, costs = bodies.poses.take(parents), bodies.costs[parents]
        trails = np.zeros((parents.size, LONGEST_FALL + 1, 3))
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
                ends = _Bodies(here, parents[down] + (time << 16), moves[down], costs[down], left, trails[down])
                landed.append((step + 1, self._thinned(ends.take(np.flatnonzero(np.isfinite(left))))))
            up = np.flatnonzero(~poses.grounded)
            if not up.size:
                break
            poses, costs, trails = poses.take(up), costs[up], trails[up]
            parents, moves = parents[up], moves[up]
        return landed

    def _thinned(self, bodies: _Bodies) -> _Bodies:
        """The best body of each quarter of a metre, and of those the best."""
        poses = bodies.poses
        judged = bodies.costs + bodies.left - _STAMINA * poses.stamina
        order = judged.argsort(kind="stable")
        cells = np.floor(np.stack([poses.x * 4, poses.y * 4, poses.z * 4 + 0.5, poses.crouching], axis=1))[order]
        _, first = np.unique(cells, axis=0, return_index=True)
        return bodies.take(order[np.sort(first)[: self._kept]])

    def _traced(self, taken: dict[int, _Bodies], best: tuple[float, int, int] | None) -> Plan:
        """The actions that lead to the best end, from the first on."""
        if best is None:
            return Plan((), ())
        _, time, row = best
        actions: list[Action] = []
        places: list[Point] = []
        while time:
            bodies = taken[time]
            parent, move = int(bodies.parents[row]), self._moves[int(bodies.moves[row])]
            began, row_before = parent >> 16, parent & 0xFFFF
            for step in reversed(range(time - began)):
                x, y, sprint = (move.action[0], move.action[1], move.action[4]) if step < move.hold else (0, 0, 0)
                crouch = move.action[3] if step < move.hold else 0
                actions.append((x, y, move.action[2] if step == 0 else 0, crouch, sprint))
                places.append(tuple(bodies.trails[row, step].tolist()))
            time, row = began, row_before
        return Plan(tuple(reversed(actions)), tuple(reversed(places)))


def _merged(groups: Sequence[_Bodies]) -> _Bodies:
    poses = joined([group.poses for group in groups])
    return _Bodies(poses, *(np.concatenate([getattr(group, name) for group in groups]) for name in _OTHERS))
