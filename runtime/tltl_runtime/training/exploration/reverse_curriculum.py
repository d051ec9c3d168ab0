"""The reverse curriculum: episodes begin at points of demonstrations where the agent can learn.

A demonstration is an episode that met the spec. It is divided into segments of equal length. The
agent learns most in segments from which it sometimes succeeds. As it improves, the useful segments
move from the end of the demonstration to its beginning: Florensa et al., Reverse curriculum
generation for reinforcement learning, CoRL 2017; Salimans and Chen, Learning Montezuma's Revenge
from a single demonstration, 2018.

The *end* of a demonstration is the set of atoms that are true in its last step. The function
:func:`~tltl_runtime.training.exploration.search.end_of` returns it as a number.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.training.exploration.action_encoding import ActionEncoding, Actions
from tltl_runtime.training.exploration.replayed_starts import EpisodeStart
from tltl_runtime.training.exploration.search import FailedEpisode, SuccessfulEpisode

_MAX_DEMONSTRATIONS = 6
"""At most this many demonstrations are kept for each end: the shortest, with different seeds."""
_MAX_ENDS = 8
"""At most this many ends are kept: the first that were found."""
_START_SHARES = 0.2, 0.97
"""How much of the training begins at the level's start, not in a demonstration: two shares in [0, 1].

At least the first share of decisions is made in episodes that begin at the level's start. At most
the second share of episodes begins there. The first counts decisions, because failed episodes
differ in length: some last until the spec's limit, others end soon in a violation.
"""
_MIN_WEIGHT = 0.005
"""This is added to the weight of each segment.

A segment that teaches nothing now may be useful later.
"""
_LEARNED_RATE = 0.2
"""A segment counts as learned, at least partly, if its success rate is at least this."""
_WEIGHTS_BEFORE = 0.1, 0.6
"""The weight just before the first learned segment, and the factor for each segment before that.

Segments far from everything learned give long episodes without success, and PPO would learn only
from their noise. So their weights are small.
"""
_STEP_SIZES = 0.1, 0.02
"""The step sizes of exponential moving averages.

The first is for the success rate of a segment, the second for the success rate from the level's
start and for mean lengths.
"""
_MAX_FAILURES = 32
"""At most this many failed episodes from the level's start are kept: the last ones."""
_DECISION_LIMIT = 1.5, 20
"""How many decisions the agent may make from a start in a demonstration.

The limit is the first number times the demonstration's remaining decisions, plus the second number.
"""


class ReverseCurriculum:
    """Draws the starts of training episodes, and learns from the results of these episodes.

    ``segments`` is the number of segments of a demonstration. ``encoding`` checks and stores the
    actions. Nothing else may draw from ``generator``, because equal seeds must give equal
    trainings.

    The *end* of a demonstration is a number for the atoms that are true in its last step.
    ``demonstrations`` maps each end to the shortest known demonstrations with that end, including
    the agent's own successes. They are kept by end because a spec may be met in several ways, and
    the shortest of all demonstrations would hide the other ways. ``rates`` maps each end to the
    success rates [segments] of episodes that began in each segment of its demonstrations.
    ``start_rate`` is the success rate from the level's start. All rates are in [0, 1]. ``lengths``
    has two mean numbers of the agent's decisions: in episodes from the level's start, and in
    episodes from demonstrations. ``failures`` are the last failed episodes from the level's start.
    """

    def __init__(self, segments: int, generator: np.random.Generator, encoding: ActionEncoding) -> None:
        self._random = generator
        self._encoding = encoding
        self._segments = segments
        self.demonstrations: dict[int, list[SuccessfulEpisode]] = {}
        self.rates: dict[int, NDArray[np.float64]] = {}
        self.start_rate = 0.0
        self.lengths = np.full(2, 100.0)
        self.failures: deque[FailedEpisode] = deque(maxlen=_MAX_FAILURES)

    def add(self, demonstration: SuccessfulEpisode) -> None:
        """Keep a demonstration if it is among the shortest with its end.

        A demonstration with a new end is not kept if there are ``_MAX_ENDS`` ends already.
        """
        if demonstration.end not in self.demonstrations:
            if len(self.demonstrations) == _MAX_ENDS:
                return
            self.demonstrations[demonstration.end] = []
            self.rates[demonstration.end] = np.zeros(self._segments)
            # Learning begins at the last segment.
            self.rates[demonstration.end][-1] = 0.5
        shortest: dict[int, SuccessfulEpisode] = {}
        for candidate in sorted(
            [*self.demonstrations[demonstration.end], demonstration], key=lambda candidate: len(candidate.actions)
        ):
            # At most one per seed, so that the agent does not memorise what the guards do with that seed.
            shortest.setdefault(candidate.seed, candidate)
        self.demonstrations[demonstration.end] = list(shortest.values())[:_MAX_DEMONSTRATIONS]

    def draw(self) -> EpisodeStart:
        """Draw the start of the next episode.

        The more often the agent succeeds from the level's start, the more episodes begin there.
        """
        seed = int(self._random.integers(2**31))
        if not self.demonstrations or self._random.random() < self._start_probability():
            return EpisodeStart(seed)
        ends = list(self.rates)
        weights = np.concatenate([_weights(rates) for rates in self.rates.values()])
        index, segment = divmod(int(self._random.choice(len(weights), p=weights / weights.sum())), self._segments)
        demonstrations = self.demonstrations[ends[index]]
        demonstration = demonstrations[self._random.integers(len(demonstrations))]
        at = int(len(demonstration.actions) * (segment + self._random.random()) / self._segments)
        times, extra = _DECISION_LIMIT
        max_decisions = int((len(demonstration.actions) - at) * times) + extra
        return EpisodeStart(demonstration.seed, demonstration.actions[:at], (demonstration.end, segment), max_decisions)

    def draw_decisions(self, count: int) -> list[tuple[SuccessfulEpisode, int]]:
        """Draw up to ``count`` decisions to imitate: pairs of a demonstration and the index of an action.

        First draw ``count`` decisions from the same segments as :meth:`draw` does. Then drop each
        decision with a probability: the agent's success rate from the decision's segment, or from
        an earlier segment or the level's start, if that is greater. Return an empty list if there
        are no demonstrations.
        """
        if not self.demonstrations:
            return []
        rates = np.concatenate(
            [np.maximum.accumulate(np.maximum(segment_rates, self.start_rate)) for segment_rates in self.rates.values()]
        )
        weights = np.concatenate([_weights(segment_rates) for segment_rates in self.rates.values()])
        drawn = self._random.choice(len(weights), size=count, p=weights / weights.sum())
        drawn = drawn[self._random.random(count) >= rates[drawn]]
        ends, decisions = list(self.rates), []
        for index, segment in zip(*divmod(drawn, self._segments), strict=True):
            demonstrations = self.demonstrations[ends[index]]
            demonstration = demonstrations[self._random.integers(len(demonstrations))]
            decisions.append(
                (demonstration, int(len(demonstration.actions) * (segment + self._random.random()) / self._segments))
            )
        return decisions

    def record_episode(self, start: EpisodeStart, actions: Actions, end: int | None, state: int | None = None) -> None:
        """Update the curriculum with the result of an episode that began at ``start``.

        ``actions`` are all actions of the episode, including the replayed ones. If the episode was
        successful, ``end`` says which atoms were true at its end (see
        :func:`~tltl_runtime.training.exploration.search.end_of`); otherwise it is None. ``state``
        is the automaton state in which the episode failed, None if the episode was cut off.
        """
        segment_step, start_step = _STEP_SIZES
        success = end is not None
        kind = int(start.segment is not None)
        self.lengths[kind] += start_step * (len(actions) - len(start.actions) - self.lengths[kind])
        if start.segment is None:
            self.start_rate += start_step * (success - self.start_rate)
            if not success and state is not None:
                self.failures.append(FailedEpisode(start.seed, actions, state))
        else:
            start_end, segment = start.segment
            self.rates[start_end][segment] += segment_step * (success - self.rates[start_end][segment])
        if end is not None:
            self.add(SuccessfulEpisode(start.seed, actions, end))

    def state(self) -> dict[str, NDArray[Any]]:
        """Return the state of the curriculum as arrays by name, for :meth:`load`.

        The state of the random generator is not included.
        """
        demonstrations = [demonstration for same_end in self.demonstrations.values() for demonstration in same_end]
        return {
            **_arrays(
                "way",
                [(demonstration.seed, demonstration.actions, demonstration.end) for demonstration in demonstrations],
                self._encoding.dtype,
            ),
            **_arrays(
                "failure",
                [(failure.seed, failure.actions, failure.state) for failure in self.failures],
                self._encoding.dtype,
            ),
            "rates": np.array(list(self.rates.values())),
            "passed": np.array([self.start_rate]),
            "lengths": self.lengths.copy(),
        }

    def load(self, state: Mapping[str, NDArray[Any]]) -> None:
        """Restore what :meth:`state` returned. Raises ValueError if the arrays are invalid."""
        for name in ("way", "failure"):
            _check_episodes(name, state, self._encoding)
        self.demonstrations, self.rates = {}, {}
        for demonstration in _episodes("way", state):
            self.add(SuccessfulEpisode(*demonstration))
        _check_array(
            "rates", state, np.float64, (len(self.demonstrations), self._segments) if self.demonstrations else (0,)
        )
        _check_array("passed", state, np.float64, (1,))
        _check_array("lengths", state, np.float64, (2,))
        _check_figures(state)
        self.rates = dict(zip(self.rates, state["rates"].copy(), strict=True))
        self.failures.clear()
        self.failures.extend(FailedEpisode(*fields) for fields in _episodes("failure", state))
        self.start_rate = float(state["passed"][0])
        self.lengths = state["lengths"].copy()

    def _start_probability(self) -> float:
        """Return the probability that the next episode begins at the level's start."""
        share, most = _START_SHARES
        from_start, from_demonstrations = self.lengths
        least = min(most, share / (share + (1 - share) * from_start / from_demonstrations))
        # Few episodes may have begun at the level's start itself, so the first segments count, too.
        rate = max(self.start_rate, float(np.mean([rates[0] for rates in self.rates.values()])))
        return float(least + (most - least) * rate)


def _arrays(name: str, episodes: Sequence[tuple[int, Actions, int]], dtype: np.dtype[Any]) -> dict[str, NDArray[Any]]:
    """Store episodes as arrays, whose names begin with ``name``.

    Each episode has a seed, actions, and a number: the end of a success, or the automaton state of
    a failure. ``dtype`` is the type of the actions.
    """
    return {
        f"{name}_seeds": np.array([seed for seed, _, _ in episodes], dtype=np.int64),
        f"{name}_ends": np.array([end for _, _, end in episodes], dtype=np.int64),
        f"{name}_lengths": np.array([len(actions) for _, actions, _ in episodes], dtype=np.int64),
        f"{name}_actions": np.array([action for _, actions, _ in episodes for action in actions], dtype=dtype),
    }


def _episodes(name: str, arrays: Mapping[str, NDArray[Any]]) -> Iterator[tuple[int, Actions, int]]:
    """Yield the episodes that :func:`_arrays` stored, each as seed, actions, and end or state."""
    seeds, ends, lengths = (arrays[f"{name}_{field}"].tolist() for field in ("seeds", "ends", "lengths"))
    actions = np.split(arrays[f"{name}_actions"], np.cumsum(lengths)[:-1]) if lengths else []
    for seed, episode_actions, end in zip(seeds, actions, ends, strict=True):
        yield seed, episode_actions.tolist(), end


def _check_array(
    name: str, arrays: Mapping[str, NDArray[Any]], dtype: type[np.generic], shape: tuple[int, ...]
) -> None:
    array = arrays.get(name)
    if array is None or array.dtype != dtype or array.shape != shape:
        kind = "" if array is None else f", not {array.dtype} of the shape {list(array.shape)}"
        raise ValueError(f"`{name}` must be {np.dtype(dtype)} of the shape {list(shape)}{kind}")


def _check_episodes(name: str, arrays: Mapping[str, NDArray[Any]], encoding: ActionEncoding) -> None:
    """Raise ValueError if the arrays of episodes have a wrong type, shape or value.

    Seeds, ends and states must not be negative, episodes must not be empty, and actions must be
    actions of the game.
    """
    count = arrays[f"{name}_seeds"].size if f"{name}_seeds" in arrays else 0
    for field in ("seeds", "ends", "lengths"):
        _check_array(f"{name}_{field}", arrays, np.int64, (count,))
    lengths = arrays[f"{name}_lengths"]
    actions = arrays.get(f"{name}_actions")
    if actions is None:
        raise ValueError(f"`{name}_actions` is missing")
    try:
        encoding.check(actions, sum(lengths.tolist()))
    except ValueError as error:
        raise ValueError(f"`{name}_actions` {error}") from None
    if (lengths < 1).any() or (arrays[f"{name}_seeds"] < 0).any() or (arrays[f"{name}_ends"] < 0).any():
        raise ValueError(f"`{name}_lengths`, `{name}_seeds` or `{name}_ends` contains a number that is too small")


def _check_figures(arrays: Mapping[str, NDArray[Any]]) -> None:
    """Raise ValueError if a success rate is outside [0, 1], or a mean length is 0, negative or not finite."""
    rates = np.append(arrays["rates"].ravel(), arrays["passed"])
    if not ((rates >= 0) & (rates <= 1)).all():
        raise ValueError("`rates` or `passed` contains a number outside 0 to 1")
    if not ((arrays["lengths"] > 0) & np.isfinite(arrays["lengths"])).all():
        raise ValueError("`lengths` contains a number that is not above 0, or not finite")


def _weights(rates: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the weight with which each segment is drawn; ``rates`` are the success rates from each.

    A segment counts as learned if its success rate is at least ``_LEARNED_RATE``; if there is none,
    the last segment counts as learned. From the first learned segment on, the weight is greatest at
    a success rate of one half. Before that segment, weights fall with the distance from it.
    """
    first = int(np.argmax(rates >= _LEARNED_RATE)) if rates.max() >= _LEARNED_RATE else len(rates) - 1
    weights: NDArray[np.float64] = rates * (1 - rates) + _MIN_WEIGHT
    most, factor = _WEIGHTS_BEFORE
    weights[:first] = most * factor ** np.arange(first - 1, -1, -1)
    return weights
