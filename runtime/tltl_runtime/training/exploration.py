"""What draws an agent to where it has seldom been: a bonus that fades with the visits of a place.

Robustness of distance is blind to walls, and once an agent stands where it is best, nothing that Algorithm 1
rewards tells one way on from another.  A bonus of ``weight / sqrt(n)`` at the n-th visit does, and goes by itself:
Strehl and Littman, An analysis of model-based interval estimation for Markov decision processes, 2008, section 3.2.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tltlc.record import record


@record
class Exploration:
    """``weight`` of the bonus, in units of reward, for the first visit of a place; 0 is none."""

    weight: float


class Visits:
    """How often each place was visited: a place is a cell of the level in a state of the automaton."""

    def __init__(self, weight: float, states: int) -> None:
        self._weight = weight
        self._states = states
        self.counts: NDArray[np.int64] = np.zeros(0, dtype=np.int64)
        """By ``cell * states + state``; cells that nobody saw yet may be missing at the end."""

    def bonus(self, cells: NDArray[np.int64], states: NDArray[np.int64]) -> NDArray[np.float64]:
        """Count a visit of each environment and return its bonus [num_envs]: none where the cell is -1."""
        bonus = np.zeros(len(cells))
        there = cells >= 0
        places = cells[there] * self._states + states[there]
        if places.max(initial=-1) >= len(self.counts):
            self.counts = np.pad(self.counts, (0, int(places.max()) + 1 - len(self.counts)))
        np.add.at(self.counts, places, 1)
        bonus[there] = self._weight / np.sqrt(self.counts[places])
        return bonus
