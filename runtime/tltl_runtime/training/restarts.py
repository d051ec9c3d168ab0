"""Where on known ways episodes of a training begin, so that the agent always has something within reach to learn.

A way is divided into parts.  Those from which the agent succeeds now and then teach it most; they move from the end
of the way to its beginning as it learns: Florensa et al., Reverse curriculum generation for reinforcement learning,
CoRL 2017; Salimans and Chen, Learning Montezuma's Revenge from a single demonstration, 2018.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.training.search import Way
from tltl_runtime.training.starts import Actions, Start

_WAYS = 8
"""As many of the shortest ways are kept."""
_FRESH = 0.1
"""How many episodes begin at the level's start in any case."""
_LEAST = 0.01
"""The weight of a part that teaches nothing now: it may do so again."""
_RATE = 0.1, 0.02
"""How fast success rates follow the episodes: those of a part, that from the level's start."""
_SPARE = 1.5, 20
"""An episode may take so many times what is left of the way, and so many decisions more."""


class Restarts:
    """Draws starts; ``generator`` is its own.

    ``ways`` are the shortest ones that are known; the agent's own successes join them.  ``rates`` are the success
    rates from each part, in [0, 1], ``passed`` is that from the level's start.
    """

    def __init__(self, ways: Sequence[Way], parts: int, generator: np.random.Generator) -> None:
        self._random = generator
        self.ways = list(ways)
        self.rates: NDArray[np.float64] = np.zeros(parts)
        # The end of a way is where the learning begins.
        self.rates[-1] = 0.5
        self.passed = 0.0
        self._keep_shortest()

    def draw(self) -> Start:
        """Where the next episode begins: the more often at the level's start, the better the agent is from there."""
        seed = int(self._random.integers(2**31))
        if not self.ways or self._random.random() < _FRESH + (1 - 2 * _FRESH) * self.passed:
            return Start(seed)
        weights = self.rates * (1 - self.rates) + _LEAST
        part = int(self._random.choice(len(weights), p=weights / weights.sum()))
        way = self.ways[self._random.integers(len(self.ways))]
        at = int(len(way.actions) * (part + self._random.random()) / len(weights))
        times, more = _SPARE
        return Start(way.seed, way.actions[:at], part, int((len(way.actions) - at) * times) + more)

    def ended(self, start: Start, actions: Actions, success: bool) -> None:
        """Learn how an episode ended that began at ``start``; ``actions`` are all of it."""
        of_part, from_start = _RATE
        if start.part is None:
            self.passed += from_start * (success - self.passed)
        else:
            self.rates[start.part] += of_part * (success - self.rates[start.part])
        if success and (len(self.ways) < _WAYS or len(actions) < len(self.ways[-1].actions)):
            self.ways.append(Way(start.seed, actions))
            self._keep_shortest()

    def state(self) -> dict[str, NDArray[Any]]:
        """All but the generator, as arrays, for :meth:`load`."""
        actions = [action for way in self.ways for action in way.actions]
        return {
            "way_seeds": np.array([way.seed for way in self.ways], dtype=np.int64),
            "way_lengths": np.array([len(way.actions) for way in self.ways], dtype=np.int64),
            "way_actions": np.array(actions, dtype=np.int8),
            "rates": self.rates.copy(),
            "passed": np.array([self.passed]),
        }

    def load(self, state: Mapping[str, NDArray[Any]]) -> None:
        """Take up what :meth:`state` gave."""
        ends = np.cumsum(state["way_lengths"])[:-1]
        actions = np.split(state["way_actions"], ends) if len(state["way_seeds"]) else []
        self.ways = [Way(int(seed), own.tolist()) for seed, own in zip(state["way_seeds"], actions, strict=True)]
        self.rates = state["rates"].copy()
        self.passed = float(state["passed"][0])

    def _keep_shortest(self) -> None:
        self.ways.sort(key=lambda way: len(way.actions))
        del self.ways[_WAYS:]
