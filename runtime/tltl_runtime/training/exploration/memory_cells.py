"""What a spec remembers, as a number: a part of the cells of a search.

Two moments with the same place and automaton state may differ in what the spec remembers: whether the
key was picked up before, or how much of a deadline is left. So the search keeps them apart.
"""

from __future__ import annotations

from typing import Any, Final

from numpy.typing import NDArray

from tltl_runtime.spec.automaton_observation import observed_registers
from tltlc.api import Fspa

_TRUTHS: Final = ("once", "historically", "since", "due")
"""Registers of these kinds count as true or false."""
_AMOUNTS: Final = (
    "times",
    "times_since",
    "times_within",
    "time_since",
    "time_holding",
    "total_time",
    "total_time_since",
    "age",
    "waiting",
    "highest",
    "lowest",
    "highest_since",
    "lowest_since",
)
"""The ranges of registers of these kinds are divided into bins.

Other registers say little that the state, the place or these do not say, and change at each step.
"""
_BINS: Final = 8
"""A count or time stops at about twice the number that it is compared with, so half of these bins matter."""
_MOST_REGISTERS: Final = 6
"""The most registers that count: with more, no cell would be reached twice."""


class MemoryCells:
    """Computes the number of what a spec remembers, from the key ``automaton`` of an observation.

    Registers without a finite range do not count.
    """

    def __init__(self, fspa: Fspa) -> None:
        places = enumerate(observed_registers(fspa), start=len(fspa.states))
        kinds = [(place, fspa.registers[register.index].kind) for place, register in places]
        bins = [(place, 2) for place, kind in kinds if kind in _TRUTHS]
        bins += [(place, _BINS) for place, kind in kinds if kind in _AMOUNTS]
        self._bins = bins[:_MOST_REGISTERS]

    def number(self, automaton: NDArray[Any]) -> int:
        """Return the number, at least 0, for a row of the key ``automaton``."""
        result = 0
        for place, bins in self._bins:
            share = float(automaton[place])
            # A truth at the border, 0, is false.
            index = int(share > 0.5) if bins == 2 else min(int(share * bins), bins - 1)
            result = result * bins + index
        return result
