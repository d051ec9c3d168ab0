"""Random choices that are the same on every machine and in every version of Python."""

from __future__ import annotations

from collections.abc import Sequence
from random import Random
from typing import TypeVar

T = TypeVar("T")


class Draw:
    """A source of random choices that depend only on its seed.

    All choices are computed from ``Random.random``, whose numbers Python promises not to change.
    """

    def __init__(self, seed: int) -> None:
        self._random = Random(seed).random

    def below(self, count: int) -> int:
        """Return a random whole number from 0 to ``count`` - 1."""
        return int(self._random() * count)

    def choice(self, items: Sequence[T]) -> T:
        """Return one of the items, chosen at random."""
        return items[self.below(len(items))]

    def chance(self, share: float) -> bool:
        """Return True with a probability of ``share``, in [0, 1]."""
        return self._random() < share

    def between(self, low: float, high: float) -> float:
        """Return a random number from [low, high), rounded to three decimals."""
        return round(low + (high - low) * self._random(), 3)
