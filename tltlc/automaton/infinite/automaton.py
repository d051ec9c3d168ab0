"""Deterministic Rabin automata whose edges, not states, decide acceptance."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

from tltlc.automaton.diagrams import Diagrams
from tltlc.automaton.fspa import Mark
from tltlc.core.record import record

PairMarks = frozenset[Mark]
"""The marks of an edge: ``(pair, "fin")`` or ``(pair, "inf")`` for each set of a Rabin pair that contains the edge."""

NO_MARKS: Final[PairMarks] = frozenset()


@record
class Rabin:
    """A deterministic, complete Rabin automaton. Its states are ints, and state 0 is initial.

    ``steps[q]`` is a function in the table ``letters``: it maps the letter read in state ``q`` to
    the next state and the marks of the edge, or to None if ``exclusive`` rules the letter out.
    ``labels[q]`` is the formula that remains in state ``q``, or other data that identifies ``q``.

    There are ``pairs`` Rabin pairs. A run is accepted if, for at least one pair, it takes edges
    with the mark ``(pair, "inf")`` infinitely often and edges with ``(pair, "fin")`` only finitely
    often.
    """

    letters: Diagrams[Any]
    steps: tuple[int, ...]
    labels: tuple[Any, ...]
    pairs: int

    def leaves(self, state: int) -> list[tuple[int, PairMarks]]:
        """Return the successors of a state, each with the marks of the edge that leads there."""
        return [leaf for leaf in self.letters.values(self.steps[state]) if leaf is not None]

    def step(self, state: int, letter: Sequence[bool]) -> tuple[int, PairMarks]:
        """Return the state after a letter, and the marks of the edge taken.

        ``letter`` has a truth value for each atom.
        """
        successor: tuple[int, PairMarks] = self.letters.at(self.steps[state], letter.__getitem__)
        return successor
