"""Say when something in an episode happened: in seconds if the game has a clock, else in steps."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def has_clock(times: NDArray[np.float64]) -> bool:
    """Whether the ``times`` of an episode, (n + 1,), are seconds; without a clock, they are the numbers of its steps.

    The times of a game with a clock of 1 Hz are both.
    """
    return not np.array_equal(times, np.arange(len(times)))


def moment_text(times: NDArray[np.float64], row: int) -> str:
    """Return the moment of a row of an episode, from 0 at the reset: ``3.20 s``, or ``step 32`` without a clock."""
    return f"{times[row]:.2f} s" if has_clock(times) else f"step {row}"


def duration_text(times: NDArray[np.float64]) -> str:
    """Return how long an episode took: ``3.20 s``, or ``32 steps`` without a clock."""
    steps = len(times) - 1
    return f"{times[-1]:.2f} s" if has_clock(times) else f"{steps} step{'s' * (steps != 1)}"
