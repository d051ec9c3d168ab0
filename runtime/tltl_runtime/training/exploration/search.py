"""Search for episodes that meet the spec (ways) with random actions, before learning begins.

Robustness ignores walls: an agent that only follows it gets stuck where the distance is least, and
random actions alone never crouch, climb and jump in the right order.  So the search returns to the
places that it has reached, by replaying the actions that led there, and takes random actions from
there.  This is Go-Explore: Ecoffet et al., First return, then explore, Nature 590, 2021.  A place,
Go-Explore's cell, is a cell of the level together with a state of the automaton.  So the search
needs no knowledge about the level.

An episode from a place keeps the seed of the episode that found the place.  Everything that the
level draws from the seed stays the same, for example which door opens.  So the places of a seed are
dropped as soon as a way with that seed is found.

If learning comes to a standstill, another search begins in the agent's failed episodes.  If a
training begins with a policy, that policy plays first, because it may already meet the spec.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.training.exploration.replayed_starts import Actions, Episodes, EpisodeStart
from tltl_runtime.vector import WorkerVectorEnv
from tltlc.api import record

_KEPT = 0.9
"""The probability that a branch keeps its choice in the next decision.

Independent choices would lead nowhere.
"""
_BURST = 60
"""The number of random decisions from a place."""
_FRESH = 0.05
"""The share of episodes that begin at the level's start."""
_FAILED = 0.3
"""If there are failed episodes, this share of episodes begins in one.

No episode then begins at the level's start.
"""
_TOLD_EVERY_S = 0.5


Player = Callable[[Mapping[str, NDArray[Any]]], NDArray[np.int64]]
"""Returns the action [branches] for the observation of one environment."""


@record
class Exploration:
    """The settings of the search before the training, and of the use of its ways.

    The search ends when ``ways`` episodes with different seeds have met the spec (0: no search), or
    after ``steps`` decisions, not counting replayed ones.  Each way is divided into ``parts``, at
    which episodes of the training may begin.  Each update is followed by ``imitation`` optimiser
    steps of self-imitation of the ways.
    """

    ways: int
    steps: int
    parts: int
    imitation: int


@record
class SuccessfulEpisode:
    """An episode that met the spec: its seed, all actions, and its ``end`` from :func:`end_of`."""

    seed: int
    actions: Actions
    end: int


def end_of(infos: Mapping[str, Any], row: int) -> int:
    """Return how the episode in a row of the ``final_info`` of a vector environment ended.

    The result is a bit mask: bit i says whether the spec's i-th atom was true.
    """
    atoms = infos["atoms"]
    # Gymnasium adds a mask `_name` for each name.  An int64 holds at most 63 bits.
    names = [name for name in atoms if f"_{name}" in atoms][:63]
    return sum(1 << index for index, name in enumerate(names) if atoms[name][row] > 0)


@record
class Searched:
    """The progress of a search.

    ``steps`` are decisions without the ``replayed`` ones, ``places`` the number of places that were
    reached, and ``lengths`` the lengths of the ways.  ``complete`` says whether the search ended by
    its own criteria, not by a limit of the training.
    """

    steps: int
    replayed: int
    seconds: float
    places: int
    lengths: tuple[int, ...]
    complete: bool


def joined_searches(before: Searched, later: Searched) -> Searched:
    """Combine two searches of one training, whose ways are all used.

    ``places`` is that of the later one.
    """
    return Searched(
        steps=before.steps + later.steps,
        replayed=before.replayed + later.replayed,
        seconds=before.seconds + later.seconds,
        places=later.places,
        lengths=(*before.lengths, *later.lengths),
        complete=later.complete,
    )


@record
class FailedEpisode:
    """A failed episode from the level's start: its seed, all actions, and the state of failure."""

    seed: int
    actions: Actions
    state: int


class TrajectorySearch:
    """A search in the environments of ``env``.

    The environments are :class:`~tltl_runtime.training.exploration.replayed_starts.Replayed`.
    ``ways`` are the ways found so far.  Equal seeds give equal searches, whatever the number of
    workers.  With ``failures``, the search starts in these episodes and explores only the states in
    which they failed; without, it starts at the level's start.  A ``player`` plays the first
    episode of each environment; random actions then continue from the places that it reached.
    """

    def __init__(
        self,
        env: WorkerVectorEnv,
        exploration: Exploration,
        seed: np.random.SeedSequence,
        failures: Sequence[FailedEpisode] = (),
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
        self.ways: list[SuccessfulEpisode] = []

    def run(self) -> Iterator[Searched]:
        """Search; yield the progress from time to time, and once at the end."""
        began = reported = time.perf_counter()
        episodes = Episodes(self._env, self._draw)
        choices = np.array(self._env.single_action_space.nvec)  # type: ignore[attr-defined]
        shape = self._env.num_envs, len(choices)
        action = self._random.integers(0, choices, size=shape)
        left = np.full(self._env.num_envs, _BURST)
        by_player = np.full(self._env.num_envs, self._player is not None)
        observation, steps = episodes.observation, 0
        while steps < self._exploration.steps and len(self.ways) < self._exploration.ways:
            kept = self._random.random(shape) < _KEPT
            action = np.where(kept, action, self._random.integers(0, choices, size=shape))
            if self._player:
                for row in np.flatnonzero(by_player).tolist():
                    action[row] = self._player({name: values[row] for name, values in observation.items()})
            observation, _, terminated, truncated, infos = episodes.step(action)
            steps += self._env.num_envs
            over = terminated | truncated
            by_player &= ~over
            left -= 1
            for row in range(self._env.num_envs):
                if not over[row]:
                    if self._note(episodes, row, infos):
                        left[row] = max(left[row], _BURST // 2)
                elif infos["final_info"]["success"][row]:
                    self._add(
                        SuccessfulEpisode(
                            episodes.starts[row].seed, episodes.actions[row], end_of(infos["final_info"], row)
                        )
                    )
            spent = ~over & ~by_player & (left <= 0)
            episodes.turn(over)
            if spent.any():
                episodes.cut(spent)
            left[over | spent] = _BURST
            if time.perf_counter() - reported > _TOLD_EVERY_S:
                reported = time.perf_counter()
                yield self._searched(steps, episodes.replayed, reported - began, complete=False)
        yield self._searched(steps, episodes.replayed, time.perf_counter() - began, complete=True)

    def _note(self, episodes: Episodes, row: int, infos: dict[str, NDArray[np.int64]]) -> bool:
        """Record the current place of an environment; return whether it is new."""
        state, cell, seed = int(infos["state"][row]), int(infos["cell"][row]), episodes.starts[row].seed
        if cell < 0 or any(way.seed == seed for way in self.ways) or (self._states and state not in self._states):
            return False
        self._places.add((state, cell))
        return self._known.note(state, cell, seed, episodes.actions[row])

    def _add(self, way: SuccessfulEpisode) -> None:
        if all(known.seed != way.seed for known in self.ways):
            self.ways.append(way)
            self._known.forget(way.seed)
            self._failures = [failure for failure in self._failures if failure.seed != way.seed]

    def _draw(self) -> EpisodeStart:
        """Draw the start of an episode: mostly a known place.

        Otherwise a point in the second half of a failed episode, or a new seed if there are no
        failures.
        """
        if self._known and self._random.random() >= (_FAILED if self._failures else _FRESH):
            return self._known.draw()
        if not self._failures:
            return EpisodeStart(int(self._random.integers(2**31)))
        failure = self._failures[self._random.integers(len(self._failures))]
        length = len(failure.actions)
        return EpisodeStart(failure.seed, failure.actions[: int(self._random.integers(length // 2, length))])

    def _searched(self, steps: int, replayed: int, seconds: float, *, complete: bool) -> Searched:
        lengths = tuple(sorted(len(way.actions) for way in self.ways))
        return Searched(steps, replayed, seconds, len(self._places), lengths, complete)


class _Known:
    """The known places: by state and cell, the fewest actions there and the number of starts."""

    def __init__(self, random: np.random.Generator) -> None:
        self._random = random
        self._starts: dict[int, dict[int, EpisodeStart]] = {}
        self._begun: dict[int, dict[int, int]] = {}

    def __bool__(self) -> bool:
        return bool(self._starts)

    def note(self, state: int, cell: int, seed: int, actions: Actions) -> bool:
        """Keep the actions to a place if they are the fewest; return whether the place is new."""
        starts = self._starts.setdefault(state, {})
        known = starts.get(cell)
        if known is None or len(actions) < len(known.actions):
            starts[cell] = EpisodeStart(seed, list(actions))
            self._begun.setdefault(state, {}).setdefault(cell, 0)
        return known is None

    def draw(self) -> EpisodeStart:
        """Draw a place: first a state uniformly, then a cell with weight 1 / sqrt(1 + times drawn).

        States are uniform so that later ones, which have few places, count as much as the first.
        """
        state = list(self._starts)[self._random.integers(len(self._starts))]
        begun = self._begun[state]
        weights = (1.0 + np.fromiter(begun.values(), np.float64)) ** -0.5
        cell = list(begun)[self._random.choice(len(weights), p=weights / weights.sum())]
        begun[cell] += 1
        return self._starts[state][cell]

    def forget(self, seed: int) -> None:
        """Remove the places that were reached with a seed."""
        for state in list(self._starts):
            kept = {cell: start for cell, start in self._starts[state].items() if start.seed != seed}
            if kept:
                self._starts[state] = kept
                self._begun[state] = {cell: self._begun[state][cell] for cell in kept}
            else:
                del self._starts[state], self._begun[state]
