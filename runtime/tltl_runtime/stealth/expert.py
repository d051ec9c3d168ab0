"""A scripted player that finishes levels: it knows the level and the spec, and sees what a player sees."""

from __future__ import annotations

from typing import Any

import gymnasium

from tltl_runtime.stealth.game import Snapshot
from tltl_runtime.stealth.goals import next_goals
from tltl_runtime.stealth.level import Level, Point
from tltl_runtime.stealth.walker import STAY, Action, Walker


class Expert:
    """Plays ``env``, a TltlEnv over a GameEnv or wrappers around one: ``reset`` after each of its resets, then ``act``.

    Where to go it reads off the automaton, how to get there off the level and what there is to see.  ``careful``
    keeps out of the sight of enemies, where there are any.
    """

    def __init__(self, env: gymnasium.Env[Any, Any], careful: bool = True) -> None:
        self._env = env
        self._task = env.get_wrapper_attr("task")
        self._game = env.get_wrapper_attr("game")
        self.level: Level = self._game.level
        self.careful = careful
        self._walker = Walker(self.level)
        self.reset()

    def reset(self) -> None:
        """Begin an episode."""
        self._walker.reset()

    def act(self) -> Action:
        """What to do now."""
        snapshot = self._game.snapshot()
        goal = self.goal(snapshot)
        return STAY if goal is None else self._walker.act(snapshot, goal)

    def goal(self, snapshot: Snapshot) -> Point | None:
        """Where the automaton sends the player now, None where there is no such place."""
        taken = self._env.get_wrapper_attr("taken")
        sample = self._env.get_wrapper_attr("sample")
        places = _places(self.level, snapshot)
        goals = next_goals(self._task.fspa, 0 if taken is None else taken.state, sample, self._task.params, places)
        return places[goals[0]] if goals else None


def play_episode(env: gymnasium.Env[Any, Any], expert: Expert, seed: int) -> dict[str, Any]:
    """Play one episode to its end, and return its last ``info``."""
    _, info = env.reset(seed=seed)
    expert.reset()
    over = False
    while not over:
        _, _, terminated, truncated, info = env.step(expert.act())
        over = terminated or truncated
    return info


def _places(level: Level, snapshot: Snapshot) -> dict[str, Point]:
    """Where the entities are that a player can be sent to."""
    places = {each.name: each.position for each in (*level.switches, *level.exits)}
    places |= {mover.name: place for mover, place in zip(level.movers, snapshot.movers, strict=True)}
    return places | {enemy.name: place for enemy, place in zip(level.enemies, snapshot.enemies, strict=True)}
