"""Deterministic Rabin automata with acceptance on transitions."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

from tltlc.automaton.diagrams import Diagrams
from tltlc.automaton.fspa import Mark
from tltlc.core.record import record

PairMarks = frozenset[Mark]
"""The marks of a letter: ``(pair, "fin")`` and ``(pair, "inf")``."""

NO_MARKS: Final[PairMarks] = frozenset()


@record
class Rabin:
    """A deterministic, complete automaton: ``steps[q]`` is a function from the letter to a state and marks.

    A run is accepted if, for some pair, it takes ``fin`` marks finitely often and ``inf`` marks
    infinitely often.  State 0 is initial.  A step is None on letters that ``exclusive`` rules out.
    A state's label is the formula that remains, or other data that identifies it.
    """

    letters: Diagrams[Any]
    steps: tuple[int, ...]
    labels: tuple[Any, ...]
    pairs: int

    def leaves(self, state: int) -> list[tuple[int, PairMarks]]:
        """Return the successors of a state, each with its marks."""
        return [leaf for leaf in self.letters.values(self.steps[state]) if leaf is not None]

    def step(self, state: int, letter: Sequence[bool]) -> tuple[int, PairMarks]:
        """Return the state after a letter, and the letter's marks; a letter has a truth value for each atom."""
        successor: tuple[int, PairMarks] = self.letters.at(self.steps[state], letter.__getitem__)
        return successor
