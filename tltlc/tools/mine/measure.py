"""How good a proposal is: the measure that the search ranks by.

    score = support + separation - 1 - PRICE * atoms

``support`` is the share of the traces that satisfy it, ``separation`` the share of the counterexamples that violate
it, and ``atoms`` how often it names an atom, with one more for a bound.  Without its last term this is Youden's
index (Cancer 3, 1950): 1 for a spec that tells all apart, 0 for one that knows no more than a coin.
"""

from __future__ import annotations

from typing import Final

from tltlc.core.record import record
from tltlc.tools.mine.bits import Bits, Verdicts, count

PRICE: Final = 0.01
"""Of an atom: one that tells less than one trace in a hundred apart is not worth its place."""


@record
class Figures:
    """Of a proposal: how many traces satisfy it, of how many; how many counterexamples violate it, of how many."""

    accepted: int
    traces: int
    rejected: int
    counterexamples: int

    @property
    def support(self) -> float:
        """The share of the traces that satisfy it, in [0, 1]."""
        return self.accepted / self.traces

    @property
    def separation(self) -> float:
        """The share of the counterexamples that violate it, in [0, 1]; 0 where there are none."""
        return self.rejected / self.counterexamples if self.counterexamples else 0.0

    def score(self, atoms: int) -> float:
        """The measure, at most 1; rounded, so that equal ones are equal."""
        return round(self.support + self.separation - 1.0 - PRICE * atoms, 9)


def figures(bits: Bits, accepted: Verdicts) -> Figures:
    """The figures of what accepts these traces."""
    traces, counterexamples = count(bits.traces), count(bits.counterexamples)
    return Figures(count(accepted & bits.traces), traces, count(bits.counterexamples & ~accepted), counterexamples)
