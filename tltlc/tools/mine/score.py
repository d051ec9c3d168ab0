"""The score by which the search ranks proposals.

    score = support + separation - 1 - PRICE * atoms

``support`` is the share of the traces that satisfy the proposal. ``separation`` is the share of the
counterexamples that violate it. ``atoms`` is its number of atoms, as
:class:`~tltlc.tools.mine.clause.MinedClause` counts them. Without the last term, the score is
Youden's index (Cancer 3, 1950): 1 for a spec that separates all traces from all counterexamples, 0
for a spec that is no better than chance.
"""

from __future__ import annotations

from typing import Final

from tltlc.core.record import record
from tltlc.tools.mine.bits import Bits, TraceMask, count

PRICE: Final = 0.01
"""The price of an atom. An atom is worth it if it separates more than one trace in a hundred."""


@record
class Support:
    """How many of the ``traces`` a proposal accepts, and how many of the ``counterexamples`` it rejects."""

    accepted: int
    traces: int
    rejected: int
    counterexamples: int

    @property
    def support(self) -> float:
        """The share of the traces that satisfy the proposal, in [0, 1]."""
        return self.accepted / self.traces

    @property
    def separation(self) -> float:
        """The share of the counterexamples that violate the proposal, in [0, 1]; 0 if there are none."""
        return self.rejected / self.counterexamples if self.counterexamples else 0.0

    def score(self, atoms: int) -> float:
        """Return the score of a proposal with this many atoms: support + separation - 1, less a price for each atom.

        The score is at most 1. It is rounded, so that rounding errors do not make equal scores differ.
        """
        return round(self.support + self.separation - 1.0 - PRICE * atoms, 9)


def figures(bits: Bits, accepted: TraceMask) -> Support:
    """Return the figures of a proposal. ``accepted`` are the traces and counterexamples that it accepts."""
    traces, counterexamples = count(bits.traces), count(bits.counterexamples)
    return Support(count(accepted & bits.traces), traces, count(bits.counterexamples & ~accepted), counterexamples)
