"""Plan a player's next seconds: a beam search over actions, with a prediction of the motion.

A *body* is a predicted state of the player. A *decision* is a time step, for which an action is
chosen. The search compares bodies that stand on the ground, by the time that has passed and the
time that is left on their route. A jump or a fall is one move: the search simulates the move until
the body lands.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import inf
from typing import Final

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.stealth.expert.motion import Floats, Motion, Poses, concatenate, poses_of
from tltl_runtime.stealth.expert.routes import RouteField
from tltl_runtime.stealth.level import Box, Point
from tltl_runtime.stealth.world.player import DECISION, Action, PlayerState
from tltlc.api import record

LONGEST_FALL: Final = 9
"""The search drops a body that is still in the air after this many decisions."""
_STAMINA: Final = 0.3
"""In the score, a full stamina is worth as much as a route that is this many seconds shorter."""
_TOUCHED: Final = 3.0
"""The cost of touching a mover, in seconds."""
_ARRIVED: Final = 0.1
"""A body at most this many seconds from the goal has arrived."""


@record
class HeldAction:
    """An action to play once, and then to repeat while the player is in the air.

    It is played at most ``hold`` times in all. Afterwards the player falls straight down.
    """

    action: Action
    hold: int = LONGEST_FALL


@record
class ActionPlan:
    """A sequence of actions, and the predicted position of the feet after each action."""

    actions: tuple[Action, ...]
    places: tuple[Point, ...]


@record
class _Bodies:
    """The bodies of the search at one time, n predicted states of the player on the ground.

    A "decision" is a time step. Each field has one entry for each body.
    """

    poses: Poses
    costs: Floats
    """The cost of each body for touching movers, in seconds."""
    left: Floats
    """The time left on the route to the goal, in seconds."""
    began: NDArray[np.int64]
    """When the last move of each body began, in decisions from now."""
    parents: NDArray[np.int64]
    """The index of the body from which each last move began, among the bodies at that time."""
    moves: NDArray[np.int64]
    """The indices of the last moves, among the moves to choose from."""
    trails: Floats
    """The positions of the feet after each decision of the last moves, [n, LONGEST_FALL, 3]."""

    def take(self, indices: NDArray[np.intp]) -> _Bodies:
        """Return the bodies with these indices."""
        return _Bodies(self.poses.take(indices), *(getattr(self, name)[indices] for name in _COLUMNS))

    def scores(self) -> Floats:
        """Return the score of each body, in seconds; a lower score is better.

        Only scores of bodies at the same time can be compared.
        """
        return self.costs + self.left - _STAMINA * self.poses.stamina


_COLUMNS: Final = ("costs", "left", "began", "parents", "moves", "trails")


class Foresight:
    """A search for the player's best actions in the next ``ahead`` decisions (time steps).

    After each decision, the search continues from the ``kept`` best predicted states (bodies) of
    the player. ``field`` has the routes to the goal, ``moves`` are the moves to choose from.
    ``movers`` has, for each of the next ``ahead + LONGEST_FALL`` decisions, the boxes that movers
    (moving boxes) sweep in it.
    """

    def __init__(
        self,
        motion: Motion,
        field: RouteField,
        moves: Sequence[HeldAction],
        movers: Sequence[Sequence[Box]],
        ahead: int,
        kept: int,
    ) -> None:
        self._motion, self._field, self._movers = motion, field, movers
        self._moves = moves
        self._actions = np.array([move.action for move in moves], dtype=np.int64)
        self._holds = np.array([move.hold for move in moves])
        self._ahead, self._kept = ahead, kept

    def plan(self, player: PlayerState) -> ActionPlan:
        """Return the best plan for the player's next time steps.

        The plan is empty if no move leads to a place from which a route leads to the goal.
        """
        due: list[list[_Bodies]] = [[] for _ in range(self._ahead + LONGEST_FALL)]
        due[0] = [_root_body(player)]
        passed: dict[int, _Bodies] = {}
        best, end = inf, (0, 0)
        for time, groups in enumerate(due):
            if not groups:
                continue
            bodies = passed[time] = self._best(_merge(groups))
            scores = bodies.scores() + time * DECISION
            scores[(bodies.left > _ARRIVED) & (time < self._ahead)] = inf
            if time and scores.size and scores.min() < best:
                best, end = float(scores.min()), (time, int(scores.argmin()))
            if time < self._ahead and bodies.left.size:
                for later, landed in self._apply_moves(bodies, time):
                    due[time + later].append(landed)
        return self._trace(passed, *end)

    def _apply_moves(self, bodies: _Bodies, time: int) -> list[tuple[int, _Bodies]]:
        """Simulate every move from every body until the body stands on the ground.

        ``time`` is when the moves begin, in decisions (time steps) from now. Return pairs: a number
        of decisions, and the bodies that land after this number. Only the best of these bodies are
        in the pair. Bodies that do not land in time, or have no route to the goal, are left out.
        """
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
            poses, touched = self._motion.step(poses, actions, self._movers[time + step])
            costs = costs + touched * _TOUCHED
            trails[:, step] = np.stack([poses.x, poses.y, poses.z], axis=1)
            down = np.flatnonzero(poses.grounded)
            if down.size:
                landed_poses = poses.take(down)
                left = self._field.seconds_from(landed_poses.x, landed_poses.y, landed_poses.z)
                began = np.full(down.size, time)
                ends = _Bodies(landed_poses, costs[down], left, began, parents[down], moves[down], trails[down])
                landed.append((step + 1, self._best(ends.take(np.flatnonzero(np.isfinite(left))))))
            up = np.flatnonzero(~poses.grounded)
            if not up.size:
                break
            poses, costs, trails = poses.take(up), costs[up], trails[up]
            parents, moves = parents[up], moves[up]
        return landed

    def _best(self, bodies: _Bodies) -> _Bodies:
        """Return the ``kept`` best bodies.

        If several bodies are in one cube of space, a quarter of a metre wide, only the best
        standing and the best crouching one count.
        """
        poses = bodies.poses
        order = bodies.scores().argsort(kind="stable")
        cells = np.floor(np.stack([poses.x * 4, poses.y * 4, poses.z * 4 + 0.5, poses.crouching], axis=1))[order]
        _, first = np.unique(cells, axis=0, return_index=True)
        return bodies.take(order[np.sort(first)[: self._kept]])

    def _trace(self, passed: Mapping[int, _Bodies], time: int, row: int) -> ActionPlan:
        """Return the plan that leads to the body at index ``row`` of ``passed[time]``.

        ``passed`` has the bodies from which the search continued, by time.
        """
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
        return ActionPlan(tuple(reversed(actions)), tuple(reversed(places)))


def _root_body(player: PlayerState) -> _Bodies:
    """Return the player's present state as a body, from which all other bodies descend."""
    none, zero = np.array([-1]), np.zeros(1)
    return _Bodies(poses_of(player), zero, np.array([inf]), none, none, none, np.zeros((1, LONGEST_FALL, 3)))


def _merge(groups: Sequence[_Bodies]) -> _Bodies:
    poses = concatenate([group.poses for group in groups])
    return _Bodies(poses, *(np.concatenate([getattr(group, name) for group in groups]) for name in _COLUMNS))
