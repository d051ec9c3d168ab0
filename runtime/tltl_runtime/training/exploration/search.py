"""Search for demonstrations, which are episodes that meet the spec, with random actions.

The search runs before learning begins. The robustness of a spec, which says how nearly it is met,
ignores walls: an agent that only increases it gets stuck behind a wall, where the distance to the
goal is least. Random actions alone never crouch, climb and jump in the right order. So the search
returns to a cell that it has reached, by replaying the actions that led there, and takes random
actions from there. This is Go-Explore: Ecoffet et al., First return, then explore, Nature 590,
2021. A cell of the search is a cell of the level's floor together with a state of the automaton, and
with what the spec remembers. The search needs to know nothing else about the level.

An episode from a cell keeps the seed of the episode that reached the cell. So everything that the
level draws from the seed stays the same, for example which door opens. The search keeps one
demonstration for each seed. As soon as it has one, it drops all cells of that seed.

If learning comes to a standstill, another search begins in the agent's failed episodes. If a
training begins with a policy, that policy plays first, because it may already meet the spec.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.policies.spaces.values import batch_row
from tltl_runtime.training.exploration.action_encoding import ActionEncoding, Actions
from tltl_runtime.training.exploration.memory_cells import MemoryCells
from tltl_runtime.training.exploration.replayed_starts import EpisodesInProgress, EpisodeStart
from tltl_runtime.vector import WorkerVectorEnv
from tltlc.api import Diagnostic, record

_REPEAT_PROBABILITY = 0.9
"""The probability that a choice or a number of an action stays the same in the next decision.

With independent decisions, the player would hardly leave its place.
"""
_RANDOM_DECISIONS = 60
"""The number of random decisions from a cell. If they reach a new cell, more decisions follow."""
_START_SHARE = 0.05
"""The share of episodes that begin at the level's start if there are no failed episodes."""
_FAILURE_SHARE = 0.3
"""The share of episodes that begin in a failed episode if there are any.

No episode then begins at the level's start.
"""
_REPORT_INTERVAL_S = 0.5
"""The least time, in seconds, between two reports of progress."""

Place = tuple[int, int]
"""The number of a cell of the level, and the number of what the spec remembers there."""
PolicyFunction = Callable[[Any], NDArray[Any]]
"""A policy as a function from the observation of one environment to an action, as a row [width]."""


@record
class SearchSettings:
    """The settings of the search for demonstrations, and of how the training uses them.

    The search ends when ``ways`` episodes with different seeds have met the spec (0: no search), or
    after ``steps`` decisions, not counting replayed ones. Each demonstration is divided into
    ``parts`` segments, in which episodes of the training may begin. After each update, the agent
    takes ``imitation`` optimiser steps of self-imitation.
    """

    ways: int
    steps: int
    parts: int
    imitation: int


@record
class SuccessfulEpisode:
    """A demonstration, which is an episode that met the spec: its seed and all actions.

    ``end`` says which atoms were true at the end, as a bit mask (see :func:`end_of`).
    """

    seed: int
    actions: Actions
    end: int


def end_of(infos: Mapping[str, Any], row: int) -> int:
    """Return which atoms were true at the end of an episode, as a bit mask.

    Bit i says whether the spec's i-th atom, from 0, was true; only the first 63 atoms are included.
    ``infos`` is the ``final_info`` of a vector environment, and ``row`` the index of the
    environment in which the episode ended.
    """
    atoms = infos["atoms"]
    # Gymnasium adds a mask `_name` for each name. An int64 holds at most 63 bits.
    names = [name for name in atoms if f"_{name}" in atoms][:63]
    return sum(1 << index for index, name in enumerate(names) if atoms[name][row] > 0)


@record
class SearchProgress:
    """The progress of a search.

    ``steps`` counts decisions, except replayed ones, which ``replayed`` counts. ``places`` counts
    the cells that were reached: a place in the level, an automaton state, and what the spec remembers. ``lengths``
    are the lengths of the demonstrations, in decisions. ``complete`` is true if the search ended
    because it had enough demonstrations or had taken enough steps. It is false if the search goes
    on or the training ran out of time. ``dropped`` counts the cells that were left out, because the game
    did not lead there again. ``state`` is the automaton state nearest to the goal that an episode
    reached without meeting the spec; None if it is not known. ``lost`` counts the episodes that were
    lost with their games, and ``loss`` says what happened to the first of them.
    """

    steps: int
    replayed: int
    seconds: float
    places: int
    lengths: tuple[int, ...]
    complete: bool
    dropped: int = 0
    state: int | None = None
    lost: int = 0
    loss: str = ""


def combined_progress(before: SearchProgress, later: SearchProgress) -> SearchProgress:
    """Combine the progress of two searches of one training: add the counts, and join ``lengths``.

    ``places``, ``complete`` and ``state`` are those of the later search.
    """
    return SearchProgress(
        steps=before.steps + later.steps,
        replayed=before.replayed + later.replayed,
        seconds=before.seconds + later.seconds,
        places=later.places,
        lengths=(*before.lengths, *later.lengths),
        complete=later.complete,
        dropped=before.dropped + later.dropped,
        state=later.state,
        lost=before.lost + later.lost,
        loss=before.loss or later.loss,
    )


@record
class FoundWays:
    """The demonstrations that a search had found when it was stopped, and its progress then."""

    progress: SearchProgress
    demonstrations: tuple[SuccessfulEpisode, ...]


@record
class FailedEpisode:
    """A failed episode from the level's start: its seed and all actions.

    ``state`` is the automaton state at the end, or the state just before the spec was violated.
    """

    seed: int
    actions: Actions
    state: int


class TrajectorySearch:
    """A search for demonstrations, which are episodes that meet the spec, with random actions.

    The environments of ``env`` are
    :class:`~tltl_runtime.training.exploration.replayed_starts.ReplayedStartEnv`. ``demonstrations``
    are those found so far. Equal seeds give equal searches, whatever the number of workers.

    With ``failures``, the search starts in these episodes and explores only the automaton states in
    which they failed. Without ``failures``, it starts at the level's start. If there is a
    ``policy``, it plays the first episode of each environment; random actions then continue from
    the cells that it reached. What happens to games that are lost is added to ``faults``.

    ``distances`` are the distances of the automaton's states to the goal, None for traps. ``memory``
    says which moments differ in what the spec remembers; without it, none do.

    With ``earlier``, the search goes on after an earlier one that was stopped: it begins with the
    demonstrations of that search, and with its steps and seconds. The places that it had reached are
    lost.
    """

    def __init__(
        self,
        env: WorkerVectorEnv,
        exploration: SearchSettings,
        seed: np.random.SeedSequence,
        failures: Sequence[FailedEpisode] = (),
        policy: PolicyFunction | None = None,
        faults: list[Diagnostic] | None = None,
        earlier: FoundWays | None = None,
        distances: Sequence[int | None] = (),
        memory: MemoryCells | None = None,
    ) -> None:
        self._env = env
        self._policy = policy
        self._faults = [] if faults is None else faults
        self._faults_before = len(self._faults)
        self._distances, self._memory = distances, memory
        self._exploration = exploration
        self._before = earlier.progress if earlier else SearchProgress(0, 0, 0.0, 0, (), complete=False)
        self.demonstrations: list[SuccessfulEpisode] = list(earlier.demonstrations) if earlier else []
        known_seeds = {demonstration.seed for demonstration in self.demonstrations}
        self._failures = [failure for failure in failures if failure.seed not in known_seeds]
        self._states = {failure.state for failure in failures}
        self._random = np.random.default_rng(seed)
        self._archive = _CellArchive(self._random)
        self._cells: set[tuple[int, Place]] = set()
        self._dropped_starts = self._dropped_cells = 0

    def run(self) -> Iterator[SearchProgress]:
        """Search until the settings' limits.

        Yield the progress from time to time, after each demonstration, and once at the end.
        """
        reported = time.perf_counter()
        began = reported - self._before.seconds
        episodes = EpisodesInProgress(self._env, self._draw, self._faults)
        action = self._random_actions()
        decisions_left = np.full(self._env.num_envs, _RANDOM_DECISIONS)
        by_policy = np.full(self._env.num_envs, self._policy is not None)
        observation, steps = episodes.observation, self._before.steps
        reported_ways = len(self.demonstrations)
        while steps < self._exploration.steps and len(self.demonstrations) < self._exploration.ways:
            repeated = self._random.random(action.shape) < _REPEAT_PROBABILITY
            action = np.where(repeated, action, self._random_actions())
            if self._policy:
                for row in np.flatnonzero(by_policy).tolist():
                    action[row] = self._policy(batch_row(observation, row))
            observation, _, terminated, truncated, infos = episodes.step(action)
            steps += self._env.num_envs
            over = terminated | truncated
            by_policy &= ~over
            decisions_left -= 1
            for row in range(self._env.num_envs):
                if not over[row]:
                    if self._record_cell(episodes, row, observation, infos):
                        decisions_left[row] = max(decisions_left[row], _RANDOM_DECISIONS // 2)
                elif infos["final_info"]["success"][row]:
                    self._add(
                        SuccessfulEpisode(
                            episodes.starts[row].seed, episodes.actions[row], end_of(infos["final_info"], row)
                        )
                    )
            used_up = ~over & ~by_policy & (decisions_left <= 0)
            episodes.start_next(over)
            if used_up.any():
                episodes.cut_off(used_up)
            decisions_left[over | used_up] = _RANDOM_DECISIONS
            self._drop(episodes.unrepeated)
            if len(self.demonstrations) > reported_ways or time.perf_counter() - reported > _REPORT_INTERVAL_S:
                reported_ways, reported = len(self.demonstrations), time.perf_counter()
                yield self._progress(steps, episodes, reported - began, complete=False)
        yield self._progress(steps, episodes, time.perf_counter() - began, complete=True)

    def _random_actions(self) -> NDArray[Any]:
        """Draw random actions, as rows [num_envs, width].

        Choices are uniform. Numbers, before they are squashed to their bounds, have a standard
        normal distribution.
        """
        layout = ActionEncoding(self._env.single_action_space).layout
        choices = self._random.integers(0, np.array(layout.sizes), size=(self._env.num_envs, len(layout.sizes)))
        if not layout.number_count:
            return choices
        return np.hstack([choices, self._random.normal(size=(self._env.num_envs, layout.number_count))])

    def _record_cell(
        self, episodes: EpisodesInProgress, row: int, observation: Any, infos: dict[str, NDArray[np.int64]]
    ) -> bool:
        """Record the current cell of an environment; return whether it is new.

        Record nothing and return False in three cases: the player is in the air, where there is no
        cell; the search already has a demonstration with the seed of the episode; or the search
        began with failed episodes, and none of them failed in the current automaton state.
        """
        state, cell, seed = int(infos["state"][row]), int(infos["cell"][row]), episodes.starts[row].seed
        is_done = any(demonstration.seed == seed for demonstration in self.demonstrations)
        if cell < 0 or is_done or (self._states and state not in self._states):
            return False
        place = cell, self._memory.number(observation["automaton"][row]) if self._memory else 0
        self._cells.add((state, place))
        return self._archive.add(state, place, seed, episodes.actions[row])

    def _add(self, demonstration: SuccessfulEpisode) -> None:
        if all(known.seed != demonstration.seed for known in self.demonstrations):
            self.demonstrations.append(demonstration)
            self._archive.remove(demonstration.seed)
            self._failures = [failure for failure in self._failures if failure.seed != demonstration.seed]

    def _draw(self) -> EpisodeStart:
        """Draw the start of an episode.

        Mostly the episode begins at a known cell. Otherwise it begins in the second half of a
        failed episode, or at the level's start with a new seed if there are no failures.
        """
        if self._archive and self._random.random() >= (_FAILURE_SHARE if self._failures else _START_SHARE):
            return self._archive.draw()
        if not self._failures:
            return EpisodeStart(int(self._random.integers(2**31)))
        failure = self._failures[self._random.integers(len(self._failures))]
        length = len(failure.actions)
        return EpisodeStart(failure.seed, failure.actions[: int(self._random.integers(length // 2, length))])

    def _drop(self, starts: Sequence[EpisodeStart]) -> None:
        """Leave out the cells and the failed episodes to which the game did not lead again."""
        for start in starts[self._dropped_starts :]:
            self._dropped_cells += self._archive.drop(start)
            self._failures = [failure for failure in self._failures if failure.seed != start.seed]
        self._dropped_starts = len(starts)

    def _progress(self, steps: int, episodes: EpisodesInProgress, seconds: float, *, complete: bool) -> SearchProgress:
        lengths = tuple(sorted(len(demonstration.actions) for demonstration in self.demonstrations))
        lost = self._faults[self._faults_before :]
        return SearchProgress(
            steps,
            self._before.replayed + episodes.replayed,
            seconds,
            len(self._cells),
            lengths,
            complete,
            self._before.dropped + self._dropped_cells,
            self._nearest_state(),
            self._before.lost + len(lost),
            self._before.loss or (lost[0].title if lost else ""),
        )

    def _nearest_state(self) -> int | None:
        """Return the reached state with the least distance to the goal, the first of several; None without one."""
        states = sorted({state for state, _ in self._cells if state < len(self._distances)})
        known = [(distance, state) for state in states if (distance := self._distances[state]) is not None]
        return min(known)[1] if known else None


class _CellArchive:
    """The cells that the search has reached, each with the fewest known actions that lead to it.

    A cell is a place in the level, and what the spec remembers there, together with an automaton state.
    The archive also counts how often each cell was drawn.
    """

    def __init__(self, random: np.random.Generator) -> None:
        self._random = random
        self._starts: dict[int, dict[Place, EpisodeStart]] = {}
        self._draw_counts: dict[int, dict[Place, int]] = {}

    def __bool__(self) -> bool:
        return bool(self._starts)

    def add(self, state: int, cell: Place, seed: int, actions: Actions) -> bool:
        """Keep ``actions``, which lead to a cell, if they are the fewest so far; return whether the cell is new."""
        starts = self._starts.setdefault(state, {})
        known = starts.get(cell)
        if known is None or len(actions) < len(known.actions):
            starts[cell] = EpisodeStart(seed, list(actions))
            self._draw_counts.setdefault(state, {}).setdefault(cell, 0)
        return known is None

    def draw(self) -> EpisodeStart:
        """Draw a cell; return the start of an episode that replays the actions leading to it.

        First draw an automaton state, uniformly. Then draw one of its cells, with the weight
        1 / sqrt(1 + times drawn). So later states, which have few cells, count as much as the first.
        """
        state = list(self._starts)[self._random.integers(len(self._starts))]
        draw_counts = self._draw_counts[state]
        weights = (1.0 + np.fromiter(draw_counts.values(), np.float64)) ** -0.5
        cell = list(draw_counts)[self._random.choice(len(weights), p=weights / weights.sum())]
        draw_counts[cell] += 1
        return self._starts[state][cell]

    def drop(self, start: EpisodeStart) -> bool:
        """Remove the cell to which this start leads, unless other actions have been found since; return whether."""
        places = ((state, cell) for state, starts in self._starts.items() for cell in starts if starts[cell] is start)
        state, cell = next(places, (None, None))
        if state is None or cell is None:
            return False
        del self._starts[state][cell], self._draw_counts[state][cell]
        if not self._starts[state]:
            del self._starts[state], self._draw_counts[state]
        return True

    def remove(self, seed: int) -> None:
        """Remove the cells whose actions are from episodes with this seed."""
        for state in list(self._starts):
            remaining = {cell: start for cell, start in self._starts[state].items() if start.seed != seed}
            if remaining:
                self._starts[state] = remaining
                self._draw_counts[state] = {cell: self._draw_counts[state][cell] for cell in remaining}
            else:
                del self._starts[state], self._draw_counts[state]
