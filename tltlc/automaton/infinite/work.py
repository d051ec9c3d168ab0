"""How much a construction may do, counted and not timed, so that the same formula gives the same automaton."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final

STEPS_PER_STATE: Final = 400
"""Steps of work allowed for each state of a budget."""

DEFAULT_WORK: Final = 20_000_000
"""Steps that making, reading or comparing automata may take, each of one to three microseconds."""


class OutOfWork(Exception):
    """Raised when a construction has done more than it may."""


class Work:
    """What is left of a budget of steps."""

    __slots__ = ("left",)

    def __init__(self, steps: int) -> None:
        self.left = steps

    def spend(self, steps: int = 1) -> None:
        """Count steps; raises :class:`OutOfWork` where none are left."""
        self.left -= steps
        if self.left < 0:
            raise OutOfWork

    @contextmanager
    def at_most(self, steps: int) -> Iterator[None]:
        """Let what happens inside take no more than so many steps; what it takes counts outside, too."""
        aside = max(0, self.left - steps)
        self.left -= aside
        try:
            yield
        finally:
            self.left = max(self.left, 0) + aside
