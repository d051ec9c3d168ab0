"""The work budget of a construction.

Work is counted in steps and not in seconds, so that the same formula always gives the same
automaton.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final

STEPS_PER_STATE: Final = 400
"""How many steps of work a construction may take for each state that its state budget allows."""

DEFAULT_WORK: Final = 20_000_000
"""The default limit of steps for building, reading or comparing automata; a step takes one to three microseconds."""


class OutOfWork(Exception):
    """Raised when a construction has used up its work budget."""


class Work:
    """A budget of steps; ``left`` is the number of steps that remain."""

    __slots__ = ("left",)

    def __init__(self, steps: int) -> None:
        self.left = steps

    def spend(self, steps: int = 1) -> None:
        """Subtract steps from the budget; raises :class:`OutOfWork` if not enough are left."""
        self.left -= steps
        if self.left < 0:
            raise OutOfWork

    @contextmanager
    def at_most(self, steps: int) -> Iterator[None]:
        """Limit the work inside a ``with`` block to ``steps`` steps of the budget.

        Within the block, :meth:`spend` raises :class:`OutOfWork` after these steps. The steps taken
        are subtracted from the budget as usual.
        """
        aside = max(0, self.left - steps)
        self.left -= aside
        try:
            yield
        finally:
            self.left = max(self.left, 0) + aside
