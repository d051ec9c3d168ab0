"""Deterministic Rabin automata with acceptance on transitions."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

from tltlc.automaton.fspa import Mark
from tltlc.automaton.infinite.letters import Letters
from tltlc.core.record import record

PairMarks = frozenset[Mark]
"""What a letter is marked with: ``(pair, "fin")`` and ``(pair, "inf")``."""

NO_MARKS: Final[PairMarks] = frozenset()


@record
class Rabin:
    """A deterministic, complete automaton: ``steps[q]`` is a function from the letter to a state and marks.

    A run is accepted if of some pair it meets ``fin`` finitely and ``inf`` infinitely often.  State 0 is initial; a
    step is None on letters that ``exclusive`` rules out.  A state's label is the formula that remains, or what is known
    of it instead.
    """

    letters: Letters[Any]
    steps: tuple[int, ...]
    labels: tuple[Any, ...]
    pairs: int

    def leaves(self, state: int) -> list[tuple[int, PairMarks]]:
        """Where letters lead from a state, and with which marks."""
        return [leaf for leaf in self.letters.values(self.steps[state]) if leaf is not None]

    def step(self, state: int, letter: Sequence[bool]) -> tuple[int, PairMarks]:
        """The state after a letter, and its marks; a letter says of each atom whether it holds."""
        found: tuple[int, PairMarks] = self.letters.at(self.steps[state], letter.__getitem__)
        return found
