"""What agents observe of an automaton: its state, and the registers in which it remembers the trace."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite

import numpy as np
from numpy.typing import NDArray

from tltlc.api import Fspa, record


@record
class ObservedRegister:
    """A register that agents observe.

    ``index`` is its place in ``fspa.registers``. ``low`` and ``high`` bound its value; ``high - low``
    is above 0 and finite.
    """

    index: int
    name: str
    low: float
    high: float


def observed_registers(fspa: Fspa) -> tuple[ObservedRegister, ...]:
    """Return the registers that agents observe, in the order of ``fspa.registers``.

    They are those with a finite range. Agents do not observe a register without two bounds, such as
    ``highest(x)`` of a signal without a range: nothing says how to scale it.
    """
    return tuple(
        ObservedRegister(index, register.name, register.low, register.high)
        for index, register in enumerate(fspa.registers)
        if register.low is not None and register.high is not None and _is_range(register.low, register.high)
    )


def automaton_entries(fspa: Fspa) -> tuple[str, ...]:
    """Return the names of the numbers of the key ``automaton`` in an observation, in order.

    They are ``state 0``, ``state 1`` and so on, then the names of the observed registers.
    """
    states = (f"state {state.id}" for state in fspa.states)
    return (*states, *(register.name for register in observed_registers(fspa)))


class AutomatonObservation:
    """Computes the key ``automaton`` of observations, float32, shape (:func:`automaton_entries`,).

    It has the state as a one-hot vector, and then each observed register as its share of its range,
    ``(value - low) / (high - low)``, cut to [0, 1].
    """

    def __init__(self, fspa: Fspa) -> None:
        self.size = len(automaton_entries(fspa))
        self._rows: NDArray[np.float32] = np.eye(len(fspa.states), self.size, dtype=np.float32)
        self._states, self._registers = len(fspa.states), observed_registers(fspa)

    def of(self, state: int, registers: Sequence[float]) -> NDArray[np.float32]:
        """Return a new row for the number of a state and the values of all registers of the automaton."""
        row: NDArray[np.float32] = self._rows[state].copy()
        for place, register in enumerate(self._registers, self._states):
            share = (registers[register.index] - register.low) / (register.high - register.low)
            row[place] = min(max(share, 0.0), 1.0)
        return row


def _is_range(low: float, high: float) -> bool:
    return low < high and isfinite(high - low)
