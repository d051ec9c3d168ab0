"""The reverse curriculum: episodes begin at those points of known ways where the agent can learn.

A way is an episode that met the spec.  It is divided into parts.  The agent learns most from parts
where it succeeds sometimes.  As it learns, these move from the end of the way to its beginning:
Florensa et al., Reverse curriculum generation for reinforcement learning, CoRL 2017; Salimans and
Chen, Learning Montezuma's Revenge from a single demonstration, 2018.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.game.registry import registered_game
from tltl_runtime.training.exploration.replayed_starts import Actions, EpisodeStart
from tltl_runtime.training.exploration.search import FailedEpisode, SuccessfulEpisode

_WAYS = 6
"""For each end, the shortest ways are kept, at most this many and one per seed."""
_ENDS = 8
"""At most this many ends are kept: those that were found first."""
_FRESH = 0.2, 0.97
"""Limits for the episodes from the level's start.

The first is their least share of all decisions, the second their greatest share of all episodes.
The minimum counts decisions because episodes without success differ in length: some
last until the spec's limit, some end soon in a violation.
"""
_LEAST = 0.005
"""Added to the weights of parts, because a part that teaches nothing now may do so again."""
_REACHED = 0.2
"""A part counts as learned, at least partly, if its success rate is this or more."""
_AHEAD = 0.1, 0.6
"""The weight of the part just before the first learned one, and the factor for each earlier part.

Parts far from everything learned give long episodes without success, and PPO would learn only from
their noise.
"""
_RATE = 0.1, 0.02
"""The step sizes of running means.

The first is for the success rate of a part, the second for the success rate from the level's start
and for mean lengths.
"""
_FAILURES = 32
"""This many of the last failed episodes from the level's start are kept."""
_SPARE = 1.5, 20
"""The limit of an episode on a way: the rest of the way times the first number, plus the second."""


class ReverseCurriculum:
    """Draws starts from the reverse curriculum; ``generator`` must not be shared.

    ``ways`` has the shortest known ways for each end, including the agent's own successes.  They
    are kept by end because a spec may be met in several ways, and the shortest of all would hide
    the others.  ``rates`` has, for each end, the success rates from each part of its ways.  All
    rates are in [0, 1].  ``passed`` is the success rate from the level's start.  ``lengths`` are
    the mean numbers of the agent's decisions in episodes from the level's start and in episodes on
    ways.
    """

    def __init__(self, parts: int, generator: np.random.Generator) -> None:
        self._random = generator
        self._parts = parts
        self.ways: dict[int, list[SuccessfulEpisode]] = {}
        self.rates: dict[int, NDArray[np.float64]] = {}
        self.passed = 0.0
        self.lengths = np.full(2, 100.0)
        self.failures: deque[FailedEpisode] = deque(maxlen=_FAILURES)

    def add(self, way: SuccessfulEpisode) -> None:
        """Keep a way if it is among the shortest with its end."""
        if way.end not in self.ways:
            if len(self.ways) == _ENDS:
                return
            self.ways[way.end] = []
            self.rates[way.end] = np.zeros(self._parts)
            # Learning begins at the last part of a way.
            self.rates[way.end][-1] = 0.5
        shortest: dict[int, SuccessfulEpisode] = {}
        for candidate in sorted([*self.ways[way.end], way], key=lambda candidate: len(candidate.actions)):
            # At most one way per seed, so that the agent does not memorise what the guards do in it.
            shortest.setdefault(candidate.seed, candidate)
        self.ways[way.end] = list(shortest.values())[:_WAYS]

    def draw(self) -> EpisodeStart:
        """Draw the start of the next episode.

        The better the agent is from the level's start, the more often episodes begin there.
        """
        seed = int(self._random.integers(2**31))
        if not self.ways or self._random.random() < self._fresh():
            return EpisodeStart(seed)
        ends = list(self.rates)
        weights = np.concatenate([_weights(rates) for rates in self.rates.values()])
        index, part = divmod(int(self._random.choice(len(weights), p=weights / weights.sum())), self._parts)
        ways = self.ways[ends[index]]
        way = ways[self._random.integers(len(ways))]
        at = int(len(way.actions) * (part + self._random.random()) / self._parts)
        times, extra = _SPARE
        return EpisodeStart(way.seed, way.actions[:at], (way.end, part), int((len(way.actions) - at) * times) + extra)

    def lessons(self, count: int) -> list[tuple[SuccessfulEpisode, int]]:
        """Draw up to ``count`` decisions to imitate, each as a way and an index into its actions.

        Decisions are drawn like starts.  A decision is dropped with the probability that the agent
        succeeds from its part.  A success from an earlier part, or from the level's start, counts
        for all later parts.
        """
        if not self.ways:
            return []
        rates = np.concatenate(
            [np.maximum.accumulate(np.maximum(part_rates, self.passed)) for part_rates in self.rates.values()]
        )
        weights = np.concatenate([_weights(part_rates) for part_rates in self.rates.values()])
        drawn = self._random.choice(len(weights), size=count, p=weights / weights.sum())
        drawn = drawn[self._random.random(count) >= rates[drawn]]
        ends, decisions = list(self.rates), []
        for index, part in zip(*divmod(drawn, self._parts), strict=True):
            ways = self.ways[ends[index]]
            way = ways[self._random.integers(len(ways))]
            decisions.append((way, int(len(way.actions) * (part + self._random.random()) / self._parts)))
        return decisions

    def ended(self, start: EpisodeStart, actions: Actions, end: int | None, state: int | None = None) -> None:
        """Update the curriculum with the result of an episode that began at ``start``.

        ``actions`` are all of its actions, including the replayed ones.  ``end`` is the end of a
        success, or None.  ``state`` is the state in which the episode failed, None if it was cut
        off.
        """
        of_part, from_start = _RATE
        success = end is not None
        kind = int(start.part is not None)
        self.lengths[kind] += from_start * (len(actions) - len(start.actions) - self.lengths[kind])
        if start.part is None:
            self.passed += from_start * (success - self.passed)
            if not success and state is not None:
                self.failures.append(FailedEpisode(start.seed, actions, state))
        else:
            way_end, part = start.part
            self.rates[way_end][part] += of_part * (success - self.rates[way_end][part])
        if end is not None:
            self.add(SuccessfulEpisode(start.seed, actions, end))

    def state(self) -> dict[str, NDArray[Any]]:
        """Return everything but the generator as arrays, for :meth:`load`."""
        ways = [way for same_end in self.ways.values() for way in same_end]
        return {
            **_arrays("way", [(way.seed, way.actions, way.end) for way in ways]),
            **_arrays("failure", [(failure.seed, failure.actions, failure.state) for failure in self.failures]),
            "rates": np.array(list(self.rates.values())),
            "passed": np.array([self.passed]),
            "lengths": self.lengths.copy(),
        }

    def load(self, state: Mapping[str, NDArray[Any]]) -> None:
        """Restore what :meth:`state` returned.  Raises ValueError if the arrays are invalid."""
        for name in ("way", "failure"):
            _check_played(name, state)
        self.ways, self.rates = {}, {}
        for way in _lists("way", state):
            self.add(SuccessfulEpisode(*way))
        _check_array("rates", state, np.float64, (len(self.ways), self._parts) if self.ways else (0,))
        _check_array("passed", state, np.float64, (1,))
        _check_array("lengths", state, np.float64, (2,))
        _check_figures(state)
        self.rates = dict(zip(self.rates, state["rates"].copy(), strict=True))
        self.failures.clear()
        self.failures.extend(FailedEpisode(*fields) for fields in _lists("failure", state))
        self.passed = float(state["passed"][0])
        self.lengths = state["lengths"].copy()

    def _fresh(self) -> float:
        """Return the probability that the next episode begins at the level's start."""
        share, most = _FRESH
        from_start, on_ways = self.lengths
        least = min(most, share / (share + (1 - share) * from_start / on_ways))
        # Few episodes may have begun at the level's start itself, so the first parts of the ways count, too.
        passed = max(self.passed, float(np.mean([rates[0] for rates in self.rates.values()])))
        return float(least + (most - least) * passed)


def _arrays(name: str, played: Sequence[tuple[int, Actions, int]]) -> dict[str, NDArray[Any]]:
    """Return the seeds, actions and ends (or states) of episodes as arrays."""
    return {
        f"{name}_seeds": np.array([seed for seed, _, _ in played], dtype=np.int64),
        f"{name}_ends": np.array([end for _, _, end in played], dtype=np.int64),
        f"{name}_lengths": np.array([len(actions) for _, actions, _ in played], dtype=np.int64),
        f"{name}_actions": np.array([action for _, actions, _ in played for action in actions], dtype=np.int8),
    }


def _lists(name: str, arrays: Mapping[str, NDArray[Any]]) -> Iterator[tuple[int, Actions, int]]:
    """Yield the episodes that :func:`_arrays` was given."""
    seeds, ends, lengths = (arrays[f"{name}_{field}"].tolist() for field in ("seeds", "ends", "lengths"))
    actions = np.split(arrays[f"{name}_actions"], np.cumsum(lengths)[:-1]) if lengths else []
    for seed, own, end in zip(seeds, actions, ends, strict=True):
        yield seed, own.tolist(), end


def _check_array(
    name: str, arrays: Mapping[str, NDArray[Any]], dtype: type[np.generic], shape: tuple[int, ...]
) -> None:
    array = arrays.get(name)
    if array is None or array.dtype != dtype or array.shape != shape:
        kind = "" if array is None else f", not {array.dtype} of the shape {list(array.shape)}"
        raise ValueError(f"`{name}` must be {np.dtype(dtype)} of the shape {list(shape)}{kind}")


def _check_played(name: str, arrays: Mapping[str, NDArray[Any]]) -> None:
    """Raise ValueError for arrays that :func:`_arrays` cannot have returned."""
    count = arrays[f"{name}_seeds"].size if f"{name}_seeds" in arrays else 0
    for field in ("seeds", "ends", "lengths"):
        _check_array(f"{name}_{field}", arrays, np.int64, (count,))
    lengths = arrays[f"{name}_lengths"]
    actions, branches = sum(lengths.tolist()), registered_game().branches
    _check_array(f"{name}_actions", arrays, np.int8, (actions, len(branches)) if actions else (0,))
    if (lengths < 1).any() or (arrays[f"{name}_seeds"] < 0).any():
        raise ValueError(f"`{name}_lengths` or `{name}_seeds` holds a number that is too small")
    chosen = arrays[f"{name}_actions"].reshape(-1, len(branches))
    if (chosen < 0).any() or (chosen >= np.array(branches)).any():
        raise ValueError(f"`{name}_actions` holds what is no action")


def _check_figures(arrays: Mapping[str, NDArray[Any]]) -> None:
    """Raise ValueError for success rates outside [0, 1] and lengths that are not positive."""
    rates = np.append(arrays["rates"].ravel(), arrays["passed"])
    if not ((rates >= 0) & (rates <= 1)).all():
        raise ValueError("`rates` or `passed` holds a number outside 0 to 1")
    if not ((arrays["lengths"] > 0) & np.isfinite(arrays["lengths"])).all():
        raise ValueError("`lengths` holds what is no positive number")


def _weights(rates: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the weights of the parts as starts, given the success rates from there."""
    first = int(np.argmax(rates >= _REACHED)) if rates.max() >= _REACHED else len(rates) - 1
    weights: NDArray[np.float64] = rates * (1 - rates) + _LEAST
    most, less = _AHEAD
    weights[:first] = most * less ** np.arange(first - 1, -1, -1)
    return weights
