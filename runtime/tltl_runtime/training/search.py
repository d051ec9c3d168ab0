"""The search for episodes that meet the spec, by chance and without any network, before the learning begins.

Robustness is blind to walls: an agent that only follows it stays where the distance is least, and by chance alone
nobody crouches, climbs and jumps in the right order.  Here, whatever place was reached is returned to by playing the
actions that led there again, and from there chance goes on: Ecoffet et al., First return, then explore, Nature 590,
2021.  A place is a cell of the level in a state of the automaton, so nothing about the level needs to be known.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.training.starts import Actions, Episodes, Start
from tltl_runtime.vector import WorkerVectorEnv
from tltlc.record import record

_KEPT = 0.9
"""How likely a choice of an action is kept for another decision: who changes his mind all the time gets nowhere."""
_BURST = 60
"""Decisions from a place on."""
_FRESH = 0.05
"""How many episodes begin at their beginning."""
_OTHERS = 4
"""So many times as long as to the first way the search takes to find other ends, too."""
_TOLD_EVERY_S = 0.5


@record
class Exploration:
    """The search before the training, and what is made of it.

    It ends when ``ways`` episodes have met the spec (0: no search) and it has gone on for four times as long as it took
    to the first of them, so that other ends are found, too; or after ``steps`` decisions, those that are played again
    not counted.  The ways are divided into ``parts`` at which episodes of the training may begin.
    """

    ways: int
    steps: int
    parts: int


@record
class Way:
    """An episode that met the spec: its seed, all of its actions, and its ``end`` as :func:`end_of` tells it."""

    seed: int
    actions: Actions
    end: int


def end_of(infos: Mapping[str, Any], row: int) -> int:
    """How the episode ended that the ``final_info`` of a vector environment tells of in a row: bit i says whether the
    spec's i-th atom was true.
    """
    atoms = infos["atoms"]
    # Gymnasium has a mask beside each; an int64 has no more bits.
    names = [name for name in atoms if f"_{name}" in atoms][:63]
    return sum(1 << index for index, name in enumerate(names) if atoms[name][row] > 0)


@record
class Searched:
    """How far a search is: decisions (those played again apart), places that were reached, lengths of the ways."""

    steps: int
    replayed: int
    seconds: float
    places: int
    lengths: tuple[int, ...]


class Search:
    """A search in ``env``, whose environments are :class:`~tltl_runtime.training.starts.Replayed`.

    ``states`` are those of the automaton, ``ways`` what was found.  Equal seeds give equal searches, whatever the
    workers.
    """

    def __init__(
        self, env: WorkerVectorEnv, states: int, exploration: Exploration, seed: np.random.SeedSequence
    ) -> None:
        self._env = env
        self._states = states
        self._exploration = exploration
        self._random = np.random.default_rng(seed)
        self._first: dict[int, Start] = {}
        """The shortest way known to each place, by ``cell * states + state``."""
        self._chosen: list[int] = []
        """How often each place was begun at, in the order in which they were found."""
        self._places: list[int] = []
        self.ways: list[Way] = []

    def run(self) -> Iterator[Searched]:
        """Search, and say from time to time how far it is, at the end in any case."""
        began = told = time.perf_counter()
        episodes = Episodes(self._env, self._draw)
        choices = np.array(self._env.single_action_space.nvec)  # type: ignore[attr-defined]
        shape = self._env.num_envs, len(choices)
        action = self._random.integers(0, choices, size=shape)
        left = np.full(self._env.num_envs, _BURST)
        steps = first = 0
        enough = self._exploration.steps
        while steps < enough:
            kept = self._random.random(shape) < _KEPT
            action = np.where(kept, action, self._random.integers(0, choices, size=shape))
            _, _, terminated, truncated, infos = episodes.step(action)
            steps += self._env.num_envs
            over = terminated | truncated
            for row in range(self._env.num_envs):
                if not over[row]:
                    left[row] = self._note(episodes, row, infos, int(left[row]) - 1)
                elif infos["final_info"]["success"][row]:
                    end = end_of(infos["final_info"], row)
                    self.ways.append(Way(episodes.starts[row].seed, episodes.actions[row], end))
            spent = ~over & (left <= 0)
            episodes.turn(over)
            if spent.any():
                episodes.cut(spent)
            left[over | spent] = _BURST
            if self.ways and not first:
                first = steps
            if len(self.ways) >= self._exploration.ways:
                enough = min(enough, _OTHERS * first)
            if time.perf_counter() - told > _TOLD_EVERY_S:
                told = time.perf_counter()
                yield self._searched(steps, episodes.replayed, told - began)
        yield self._searched(steps, episodes.replayed, time.perf_counter() - began)

    def _note(self, episodes: Episodes, row: int, infos: dict[str, NDArray[np.int64]], left: int) -> int:
        """Take note of the place that an environment is at; how many decisions it has left."""
        cell = int(infos["cell"][row])
        if cell < 0:
            return left
        place = cell * self._states + int(infos["state"][row])
        known = self._first.get(place)
        if known is None:
            self._places.append(place)
            self._chosen.append(0)
            left = max(left, _BURST // 2)
        if known is None or len(episodes.actions[row]) < len(known.actions):
            self._first[place] = Start(episodes.starts[row].seed, list(episodes.actions[row]))
        return left

    def _draw(self) -> Start:
        """A place to begin at, the likelier the less often it was; now and then the beginning of a new episode."""
        if not self._places or self._random.random() < _FRESH:
            return Start(int(self._random.integers(2**31)))
        weights = (1.0 + np.array(self._chosen)) ** -0.5
        index = int(self._random.choice(len(weights), p=weights / weights.sum()))
        self._chosen[index] += 1
        return self._first[self._places[index]]

    def _searched(self, steps: int, replayed: int, seconds: float) -> Searched:
        lengths = tuple(sorted(len(way.actions) for way in self.ways))
        return Searched(steps, replayed, seconds, len(self._places), lengths)
