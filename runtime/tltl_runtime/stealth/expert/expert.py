"""A scripted player that completes levels.

It knows the level and the spec, and sees what a player sees.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import dist
from typing import Any, Final

import gymnasium

from tltl_runtime.game.recorder import EpisodeRecorder, EpisodeT
from tltl_runtime.spec.goals import next_goals
from tltl_runtime.stealth.expert.movers import swept_bounds
from tltl_runtime.stealth.expert.routes import Leg, routes_of, shut_barriers
from tltl_runtime.stealth.expert.sneaker import Sneaker
from tltl_runtime.stealth.expert.walker import STAY, Walker
from tltl_runtime.stealth.level import Box, Point, StealthLevel
from tltl_runtime.stealth.snapshot import Snapshot, places
from tltl_runtime.stealth.world.player import Action

_ROOM: Final = 0.5
"""A route counts as passing a mover if it comes this near to the mover's path, in metres."""


class Expert:
    """A scripted player of ``env``, which is a TltlEnv over a GameEnv, or wrappers around such an environment.

    Call ``reset`` after each reset of the environment, then ``act`` for each action. The expert
    reads its goal from the automaton, and finds its route from the level and the visible state of
    the game. If a shut barrier is in the way, the expert goes to a switch first. A ``careful``
    expert avoids the sight of enemies while its route is on the floor and passes no mover (moving
    box); elsewhere it ignores enemies.
    """

    def __init__(self, env: gymnasium.Env[Any, Any], careful: bool = True) -> None:
        self._env = env
        self._task = env.get_wrapper_attr("task")
        self._game = env.get_wrapper_attr("game")
        self.level: StealthLevel = self._game.level
        self.careful = careful
        self._walker = Walker(self.level)
        self._sneaker = Sneaker(self.level)
        self._movers = [swept_bounds(mover) for mover in self.level.movers]
        self.reset()

    def reset(self) -> None:
        """Begin an episode."""
        self._walker.reset()
        self._sneaker.reset()
        self._chosen_for: object = None
        self._destination: Point | None = None
        self._sneaks = False

    def act(self) -> Action:
        """Return the next action. If the automaton has no goal for the player, the action is to stay."""
        snapshot = self._game.snapshot()
        goal = self.goal(snapshot)
        if goal is None:
            return STAY
        if self._destination is None or (goal, snapshot.open, snapshot.active) != self._chosen_for:
            self._chosen_for = (goal, snapshot.open, snapshot.active)
            self._destination = self._next_place(snapshot, goal)
            self._sneaks = self.careful and bool(self.level.enemies) and self._is_on_floor(snapshot, self._destination)
        return (self._sneaker if self._sneaks else self._walker).act(snapshot, self._destination)

    def goal(self, snapshot: Snapshot) -> Point | None:
        """Return the position that the player should reach next, so that the automaton gets nearer to acceptance.

        Return None if there is no such position.
        """
        taken, sample = (self._env.get_wrapper_attr(name) for name in ("taken", "sample"))
        state = 0 if taken is None else taken.state
        positions = places(self.level, snapshot)
        goals = next_goals(self._task.fspa, state, sample, self._task.params, positions)
        return positions[goals[0]] if goals else None

    def _next_place(self, snapshot: Snapshot, goal: Point) -> Point:
        """Return ``goal`` if a route leads there, else the nearest switch that helps.

        A switch helps if it opens a shut barrier and a route leads to the switch. If no switch
        helps, return ``goal``.
        """
        here, routes = snapshot.player.position, routes_of(self.level, shut_barriers(snapshot))
        if routes.leads(here, goal):
            return goal
        useful = {unlock.switch for unlock in self.level.unlocks}
        for barrier, is_open in zip(self.level.barriers, snapshot.open, strict=True):
            useful.update(() if is_open else barrier.opened_by)
        candidates = [
            switch.position
            for switch, active in zip(self.level.switches, snapshot.active, strict=True)
            if not active and switch.name in useful and routes.leads(here, switch.position)
        ]
        return min(candidates, key=lambda place: dist(here, place), default=goal)

    def _is_on_floor(self, snapshot: Snapshot, goal: Point) -> bool:
        """Whether the route to a goal stays on the floor and passes no mover (a moving box)."""
        here = snapshot.player.position
        legs = routes_of(self.level, shut_barriers(snapshot)).field_from(here, goal).legs(here)
        return all(leg.kind in ("walk", "crouch") and not self._meets_mover(leg) for leg in legs)

    def _meets_mover(self, leg: Leg) -> bool:
        return any(_is_within(leg.place, box, _ROOM) for box in self._movers)


def expert_episodes(
    env: EpisodeRecorder[EpisodeT], seeds: Iterable[int], *, careful: bool = True
) -> Iterator[EpisodeT]:
    """Play an episode with the expert for each seed, and yield its recording.

    ``careful`` is an argument of :class:`Expert`.
    """
    expert = Expert(env, careful)
    for seed in seeds:
        play_episode(env, expert, seed)
        yield env.episode


def play_episode(env: gymnasium.Env[Any, Any], expert: Expert, seed: int) -> dict[str, Any]:
    """Play one episode to its end and return its last ``info``.

    If ``env`` is a ``RecordEpisode``, its ``episode`` is then the recording of this episode.
    """
    _, info = env.reset(seed=seed)
    expert.reset()
    over = False
    while not over:
        _, _, terminated, truncated, info = env.step(expert.act())
        over = terminated or truncated
    return info


def _is_within(point: Point, box: Box, metres: float) -> bool:
    return all(box.low[axis] - metres <= point[axis] <= box.high[axis] + metres for axis in range(3))
