"""Where on known ways episodes of a training begin, so that the agent always has something within reach to learn.

A way is divided into parts.  Those from which the agent succeeds now and then teach it most; they move from the end
of the way to its beginning as it learns: Florensa et al., Reverse curriculum generation for reinforcement learning,
CoRL 2017; Salimans and Chen, Learning Montezuma's Revenge from a single demonstration, 2018.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.stealth.snapshot import BRANCHES
from tltl_runtime.training.exploration.reset_distribution import Actions, Start
from tltl_runtime.training.exploration.search import Failure, Way

_WAYS = 6
"""Of the ways with the same end, as many of the shortest are kept, each of another seed."""
_ENDS = 8
"""Of the ends as many are kept as were found first."""
_FRESH = 0.2, 0.97
"""The least share of decisions in episodes that begin at the level's start, and the greatest share of such episodes.

The former is one of decisions since an episode that gets nowhere may last until the spec's limit, or end soon in a
violation.
"""
_LEAST = 0.005
"""The weight of a part that teaches nothing any more: it may do so again."""
_REACHED = 0.2
"""The success rate from which on a part counts as learned, in part at least."""
_AHEAD = 0.1, 0.6
"""The weight of the part before the first one that is, and by how much those before it weigh less, each than the next.

What is far from anything that was learned gives long episodes without any success, whose noise is all that PPO would
then learn from.
"""
_RATE = 0.1, 0.02
"""How fast success rates follow the episodes: those of a part, that from the level's start; so do mean lengths."""
_FAILURES = 32
"""Of the episodes from the level's start that failed, as many of the last are kept."""
_SPARE = 1.5, 20
"""An episode may take so many times what is left of the way, and so many decisions more."""


class Restarts:
    """Draws starts; ``generator`` is its own.

    ``ways`` has the shortest ones that are known for each end, since a spec may be met in more than one manner, and the
    shortest of all would hide the others; the agent's own successes join them.  ``rates`` has for each end the success
    rates from each part of its ways, in [0, 1]; ``passed`` is the success rate from the level's start.  ``lengths`` are
    mean decisions of the agent in an episode, of those from the level's start and of those on ways.
    """

    def __init__(self, parts: int, generator: np.random.Generator) -> None:
        self._random = generator
        self._parts = parts
        self.ways: dict[int, list[Way]] = {}
        self.rates: dict[int, NDArray[np.float64]] = {}
        self.passed = 0.0
        self.lengths = np.full(2, 100.0)
        self.failures: deque[Failure] = deque(maxlen=_FAILURES)

    def add(self, way: Way) -> None:
        """Keep a way where it is among the shortest to its end."""
        if way.end not in self.ways:
            if len(self.ways) == _ENDS:
                return
            self.ways[way.end] = []
            self.rates[way.end] = np.zeros(self._parts)
            # The end of a way is where the learning begins.
            self.rates[way.end][-1] = 0.5
        shortest: dict[int, Way] = {}
        for each in sorted([*self.ways[way.end], way], key=lambda each: len(each.actions)):
            # Of one seed no more than one: what guards do in it would be learned by heart.
            shortest.setdefault(each.seed, each)
        self.ways[way.end] = list(shortest.values())[:_WAYS]

    def draw(self) -> Start:
        """Where the next episode begins: the more often at the level's start, the better the agent is from there."""
        seed = int(self._random.integers(2**31))
        if not self.ways or self._random.random() < self._fresh():
            return Start(seed)
        ends = list(self.rates)
        weights = np.concatenate([_weights(rates) for rates in self.rates.values()])
        index, part = divmod(int(self._random.choice(len(weights), p=weights / weights.sum())), self._parts)
        ways = self.ways[ends[index]]
        way = ways[self._random.integers(len(ways))]
        at = int(len(way.actions) * (part + self._random.random()) / self._parts)
        times, more = _SPARE
        return Start(way.seed, way.actions[:at], (way.end, part), int((len(way.actions) - at) * times) + more)

    def lessons(self, count: int) -> list[tuple[Way, int]]:
        """Up to ``count`` decisions on the ways, each a way and its number, there where episodes begin and fail.

        Who succeeds from an earlier part, or from the level's start, needs no lesson on what comes later.
        """
        if not self.ways:
            return []
        rates = np.concatenate([np.maximum.accumulate(np.maximum(each, self.passed)) for each in self.rates.values()])
        weights = np.concatenate([_weights(each) for each in self.rates.values()])
        drawn = self._random.choice(len(weights), size=count, p=weights / weights.sum())
        drawn = drawn[self._random.random(count) >= rates[drawn]]
        ends, found = list(self.rates), []
        for index, part in zip(*divmod(drawn, self._parts), strict=True):
            ways = self.ways[ends[index]]
            way = ways[self._random.integers(len(ways))]
            found.append((way, int(len(way.actions) * (part + self._random.random()) / self._parts)))
        return found

    def ended(self, start: Start, actions: Actions, end: int | None, state: int | None = None) -> None:
        """Learn how an episode ended that began at ``start``: in success with this ``end``, or None, without.

        ``actions`` are all of it; ``state`` is that in which it failed, None where it was cut off.
        """
        of_part, from_start = _RATE
        success = end is not None
        kind = int(start.part is not None)
        self.lengths[kind] += from_start * (len(actions) - len(start.actions) - self.lengths[kind])
        if start.part is None:
            self.passed += from_start * (success - self.passed)
            if not success and state is not None:
                self.failures.append(Failure(start.seed, actions, state))
        else:
            way_end, part = start.part
            self.rates[way_end][part] += of_part * (success - self.rates[way_end][part])
        if end is not None:
            self.add(Way(start.seed, actions, end))

    def state(self) -> dict[str, NDArray[Any]]:
        """All but the generator, as arrays, for :meth:`load`."""
        ways = [way for known in self.ways.values() for way in known]
        return {
            **_arrays("way", [(way.seed, way.actions, way.end) for way in ways]),
            **_arrays("failure", [(each.seed, each.actions, each.state) for each in self.failures]),
            "rates": np.array(list(self.rates.values())),
            "passed": np.array([self.passed]),
            "lengths": self.lengths.copy(),
        }

    def load(self, state: Mapping[str, NDArray[Any]]) -> None:
        """Take up what :meth:`state` gave; raises ValueError where the arrays are none that it gives."""
        for name in ("way", "failure"):
            _check_played(name, state)
        self.ways, self.rates = {}, {}
        for way in _lists("way", state):
            self.add(Way(*way))
        _check_array("rates", state, np.float64, (len(self.ways), self._parts) if self.ways else (0,))
        _check_array("passed", state, np.float64, (1,))
        _check_array("lengths", state, np.float64, (2,))
        _check_figures(state)
        self.rates = dict(zip(self.rates, state["rates"].copy(), strict=True))
        self.failures.clear()
        self.failures.extend(Failure(*each) for each in _lists("failure", state))
        self.passed = float(state["passed"][0])
        self.lengths = state["lengths"].copy()

    def _fresh(self) -> float:
        """How likely the next episode begins at the level's start."""
        share, most = _FRESH
        from_start, on_ways = self.lengths
        least = min(most, share / (share + (1 - share) * from_start / on_ways))
        # From the level's start itself there may have been few episodes.
        passed = max(self.passed, float(np.mean([rates[0] for rates in self.rates.values()])))
        return float(least + (most - least) * passed)


def _arrays(name: str, played: Sequence[tuple[int, Actions, int]]) -> dict[str, NDArray[Any]]:
    """Seeds, actions and ends of what was played, as arrays."""
    return {
        f"{name}_seeds": np.array([seed for seed, _, _ in played], dtype=np.int64),
        f"{name}_ends": np.array([end for _, _, end in played], dtype=np.int64),
        f"{name}_lengths": np.array([len(actions) for _, actions, _ in played], dtype=np.int64),
        f"{name}_actions": np.array([each for _, actions, _ in played for each in actions], dtype=np.int8),
    }


def _lists(name: str, arrays: Mapping[str, NDArray[Any]]) -> Iterator[tuple[int, Actions, int]]:
    """What :func:`_arrays` was given."""
    seeds, ends, lengths = (arrays[f"{name}_{what}"].tolist() for what in ("seeds", "ends", "lengths"))
    actions = np.split(arrays[f"{name}_actions"], np.cumsum(lengths)[:-1]) if lengths else []
    for seed, own, end in zip(seeds, actions, ends, strict=True):
        yield seed, own.tolist(), end


def _check_array(
    name: str, arrays: Mapping[str, NDArray[Any]], dtype: type[np.generic], shape: tuple[int, ...]
) -> None:
    found = arrays.get(name)
    if found is None or found.dtype != dtype or found.shape != shape:
        kind = "" if found is None else f", not {found.dtype} of the shape {list(found.shape)}"
        raise ValueError(f"`{name}` must be {np.dtype(dtype)} of the shape {list(shape)}{kind}")


def _check_played(name: str, arrays: Mapping[str, NDArray[Any]]) -> None:
    """Raise ValueError for arrays that :func:`_arrays` does not make."""
    count = arrays[f"{name}_seeds"].size if f"{name}_seeds" in arrays else 0
    for what in ("seeds", "ends", "lengths"):
        _check_array(f"{name}_{what}", arrays, np.int64, (count,))
    lengths = arrays[f"{name}_lengths"]
    actions = sum(lengths.tolist())
    _check_array(f"{name}_actions", arrays, np.int8, (actions, len(BRANCHES)) if actions else (0,))
    if (lengths < 1).any() or (arrays[f"{name}_seeds"] < 0).any():
        raise ValueError(f"`{name}_lengths` or `{name}_seeds` holds a number that is too small")
    chosen = arrays[f"{name}_actions"].reshape(-1, len(BRANCHES))
    if (chosen < 0).any() or (chosen >= np.array(BRANCHES)).any():
        raise ValueError(f"`{name}_actions` holds what is no action")


def _check_figures(arrays: Mapping[str, NDArray[Any]]) -> None:
    """Raise ValueError for success rates outside [0, 1], and for lengths that are no positive numbers."""
    rates = np.append(arrays["rates"].ravel(), arrays["passed"])
    if not ((rates >= 0) & (rates <= 1)).all():
        raise ValueError("`rates` or `passed` holds a number outside 0 to 1")
    if not ((arrays["lengths"] > 0) & np.isfinite(arrays["lengths"])).all():
        raise ValueError("`lengths` holds what is no positive number")


def _weights(rates: NDArray[np.float64]) -> NDArray[np.float64]:
    """How likely episodes begin in each part, given the success rates from there."""
    first = int(np.argmax(rates >= _REACHED)) if rates.max() >= _REACHED else len(rates) - 1
    weights: NDArray[np.float64] = rates * (1 - rates) + _LEAST
    most, less = _AHEAD
    weights[:first] = most * less ** np.arange(first - 1, -1, -1)
    return weights
