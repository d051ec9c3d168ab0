"""What specs are proposed from: traces that are to satisfy them, and counterexamples that are not to."""

from __future__ import annotations

from tltlc.automaton.compare import Letter
from tltlc.core.record import record


@record
class Recorded:
    """A trace: what it is called, and of each sample the atoms that hold; there is at least one sample."""

    name: str
    letters: tuple[Letter, ...]


@record
class Evidence:
    """The traces to satisfy, at least one, and those to violate.

    ``made_up``: the counterexamples are no recordings, but made from the traces (:mod:`tltlc.tools.mine.mutants`).
    """

    traces: tuple[Recorded, ...]
    counterexamples: tuple[Recorded, ...]
    made_up: bool = False

    @property
    def all(self) -> tuple[Recorded, ...]:
        """The traces, then the counterexamples."""
        return (*self.traces, *self.counterexamples)

    def atoms(self) -> tuple[str, ...]:
        """The atoms that hold somewhere, by name."""
        return tuple(sorted({name for trace in self.all for letter in trace.letters for name in letter}))
