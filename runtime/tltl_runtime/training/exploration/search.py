"""The search for episodes that meet the spec, by chance and without any network, before the learning begins.

Robustness is blind to walls: an agent that only follows it stays where the distance is least, and by chance alone
nobody crouches, climbs and jumps in the right order.  Here, whatever place was reached is returned to by playing the
actions that led there again, and from there chance goes on: Ecoffet et al., First return, then explore, Nature 590,
2021.  A place is a cell of the level in a state of the automaton, so nothing about the level needs to be known.

What goes on from a place has the seed of the episode that found it, and whatever the level draws from that, such as the
door that opens, stays as it is.  So the places of a seed are forgotten as soon as a way was found with it.

Where the learning comes to a standstill, ways are searched for what the agent fails in: from places to which its failed
episodes led.  Where a training begins with a policy, this one plays first, since it may meet the spec already.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.training.exploration.reset_distribution import Actions, Episodes, Start
from tltl_runtime.vector import WorkerVectorEnv
from tltlc.core.record import record

_KEPT = 0.9
"""How likely a choice of an action is kept for another decision: who changes his mind all the time gets nowhere."""
_BURST = 60
"""Decisions from a place on."""
_FRESH = 0.05
"""How many episodes begin at their beginning."""
_FAILED = 0.3
"""How many begin where failed episodes led, if there are any."""
_TOLD_EVERY_S = 0.5


Player = Callable[[Mapping[str, NDArray[Any]]], NDArray[np.int64]]
"""What plays: the actions [branches] that it chooses where an environment gives this observation."""


@record
class Exploration:
    """The search before the training, and what is made of it.

    It ends when ``ways`` episodes, each of another seed, have met the spec (0: no search); or after ``steps``
    decisions, those that are played again not counted.  The ways are divided into ``parts`` at which episodes of the
    training may begin.  After each update ``imitation`` steps of the optimiser follow towards decisions on them.
    """

    ways: int
    steps: int
    parts: int
    imitation: int


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
    """How far a search is: decisions (those played again apart), places that were reached, lengths of the ways.

    It is ``complete`` where it ended by its own rule.
    """

    steps: int
    replayed: int
    seconds: float
    places: int
    lengths: tuple[int, ...]
    complete: bool


def together(before: Searched, later: Searched) -> Searched:
    """Two searches of one training, whose ways are all used; ``places`` are those of the later one."""
    return Searched(
        steps=before.steps + later.steps,
        replayed=before.replayed + later.replayed,
        seconds=before.seconds + later.seconds,
        places=later.places,
        lengths=(*before.lengths, *later.lengths),
        complete=later.complete,
    )


@record
class Failure:
    """An episode from the level's start that failed: its seed, all of its actions, and the state in which it did."""

    seed: int
    actions: Actions
    state: int


class Search:
    """A search in ``env``, whose environments are
    :class:`~tltl_runtime.training.exploration.reset_distribution.Replayed`.

    ``ways`` are what was found.  Equal seeds give equal searches, whatever the workers.  With ``failures`` it goes on
    from these, in the states in which they failed; without, from the level's start.  A ``player`` plays the first
    episode of each environment, and chance goes on from the places that it reached.
    """

    def __init__(
        self,
        env: WorkerVectorEnv,
        exploration: Exploration,
        seed: np.random.SeedSequence,
        failures: Sequence[Failure] = (),
        player: Player | None = None,
    ) -> None:
        self._env = env
        self._player = player
        self._exploration = exploration
        self._failures = list(failures)
        self._states = {failure.state for failure in failures}
        self._random = np.random.default_rng(seed)
        self._known = _Known(self._random)
        self._places: set[tuple[int, int]] = set()
        self.ways: list[Way] = []

    def run(self) -> Iterator[Searched]:
        """Search, and say from time to time how far it is, at the end in any case."""
        began = told = time.perf_counter()
        episodes = Episodes(self._env, self._draw)
        choices = np.array(self._env.single_action_space.nvec)  # type: ignore[attr-defined]
        shape = self._env.num_envs, len(choices)
        action = self._random.integers(0, choices, size=shape)
        left = np.full(self._env.num_envs, _BURST)
        played = np.full(self._env.num_envs, self._player is not None)
        observation, steps = episodes.observation, 0
        while steps < self._exploration.steps and len(self.ways) < self._exploration.ways:
            kept = self._random.random(shape) < _KEPT
            action = np.where(kept, action, self._random.integers(0, choices, size=shape))
            if self._player:
                for row in np.flatnonzero(played).tolist():
                    action[row] = self._player({name: each[row] for name, each in observation.items()})
            observation, _, terminated, truncated, infos = episodes.step(action)
            steps += self._env.num_envs
            over = terminated | truncated
            played &= ~over
            left -= 1
            for row in range(self._env.num_envs):
                if not over[row]:
                    if self._note(episodes, row, infos):
                        left[row] = max(left[row], _BURST // 2)
                elif infos["final_info"]["success"][row]:
                    self._found(Way(episodes.starts[row].seed, episodes.actions[row], end_of(infos["final_info"], row)))
            spent = ~over & ~played & (left <= 0)
            episodes.turn(over)
            if spent.any():
                episodes.cut(spent)
            left[over | spent] = _BURST
            if time.perf_counter() - told > _TOLD_EVERY_S:
                told = time.perf_counter()
                yield self._searched(steps, episodes.replayed, told - began, complete=False)
        yield self._searched(steps, episodes.replayed, time.perf_counter() - began, complete=True)

    def _note(self, episodes: Episodes, row: int, infos: dict[str, NDArray[np.int64]]) -> bool:
        """Take note of the place that an environment is at; whether it is not among the known."""
        state, cell, seed = int(infos["state"][row]), int(infos["cell"][row]), episodes.starts[row].seed
        if cell < 0 or any(way.seed == seed for way in self.ways) or (self._states and state not in self._states):
            return False
        self._places.add((state, cell))
        return self._known.note(state, cell, seed, episodes.actions[row])

    def _found(self, way: Way) -> None:
        if all(each.seed != way.seed for each in self.ways):
            self.ways.append(way)
            self._known.forget(way.seed)
            self._failures = [each for each in self._failures if each.seed != way.seed]

    def _draw(self) -> Start:
        """A place to begin at; now and then the beginning of a new episode, or the second half of one that failed."""
        if self._known and self._random.random() >= (_FAILED if self._failures else _FRESH):
            return self._known.draw()
        if not self._failures:
            return Start(int(self._random.integers(2**31)))
        failure = self._failures[self._random.integers(len(self._failures))]
        length = len(failure.actions)
        return Start(failure.seed, failure.actions[: int(self._random.integers(length // 2, length))])

    def _searched(self, steps: int, replayed: int, seconds: float, *, complete: bool) -> Searched:
        lengths = tuple(sorted(len(way.actions) for way in self.ways))
        return Searched(steps, replayed, seconds, len(self._places), lengths, complete)


class _Known:
    """The places that were reached: by state and cell the shortest way to each, and how often it was begun at."""

    def __init__(self, random: np.random.Generator) -> None:
        self._random = random
        self._starts: dict[int, dict[int, Start]] = {}
        self._begun: dict[int, dict[int, int]] = {}

    def __bool__(self) -> bool:
        return bool(self._starts)

    def note(self, state: int, cell: int, seed: int, actions: Actions) -> bool:
        """Keep the way to a place where it is the shortest; whether it is the first one."""
        starts = self._starts.setdefault(state, {})
        known = starts.get(cell)
        if known is None or len(actions) < len(known.actions):
            starts[cell] = Start(seed, list(actions))
            self._begun.setdefault(state, {}).setdefault(cell, 0)
        return known is None

    def draw(self) -> Start:
        """A place of any state alike, so that the later ones, which have few places, count as much as the first; there
        the likelier, the less often it was begun at.
        """
        state = list(self._starts)[self._random.integers(len(self._starts))]
        begun = self._begun[state]
        weights = (1.0 + np.fromiter(begun.values(), np.float64)) ** -0.5
        cell = list(begun)[self._random.choice(len(weights), p=weights / weights.sum())]
        begun[cell] += 1
        return self._starts[state][cell]

    def forget(self, seed: int) -> None:
        """Leave out what is reached with a seed."""
        for state in list(self._starts):
            kept = {cell: start for cell, start in self._starts[state].items() if start.seed != seed}
            if kept:
                self._starts[state] = kept
                self._begun[state] = {cell: self._begun[state][cell] for cell in kept}
            else:
                del self._starts[state], self._begun[state]
