"""The work budget of a construction: counted, not timed, so that the same formula gives the same automaton."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final

STEPS_PER_STATE: Final = 400
"""Steps of work for each state of a state budget."""

DEFAULT_WORK: Final = 20_000_000
"""Steps that building, reading or comparing automata may take; a step takes one to three microseconds."""


class OutOfWork(Exception):
    """Raised when a construction has used up its work budget."""


class Work:
    """A budget of steps; ``left`` is what remains of it."""

    __slots__ = ("left",)

    def __init__(self, steps: int) -> None:
        self.left = steps

    def spend(self, steps: int = 1) -> None:
        """Count steps; raises :class:`OutOfWork` if not enough are left."""
        self.left -= steps
        if self.left < 0:
            raise OutOfWork

    @contextmanager
    def at_most(self, steps: int) -> Iterator[None]:
        """Allow at most ``steps`` steps inside the ``with`` block; they are subtracted from this budget too."""
        aside = max(0, self.left - steps)
        self.left -= aside
        try:
            yield
        finally:
            self.left = max(self.left, 0) + aside
