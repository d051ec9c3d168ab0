"""The evidence for proposals: traces that must satisfy them, and counterexamples that must not."""

from __future__ import annotations

from tltlc.automaton.compare import Letter
from tltlc.core.record import record
from tltlc.tools.witness.step_lengths import atoms_of


@record
class LabelledTrace:
    """A trace with at least one sample: its name, and a letter for each sample, the set of the atoms that hold.

    If the clock varies, letters have the lengths of steps, too (:mod:`tltlc.tools.witness.step_lengths`). These are
    no atoms, and no clause may name them.
    """

    name: str
    letters: tuple[Letter, ...]


@record
class Evidence:
    """The traces that a proposal should accept, and the counterexamples that it should reject.

    There is at least one trace. ``made_up`` is true if the counterexamples are not recordings, but
    generated from the traces (:mod:`tltlc.tools.mine.mutants`). ``clock_s`` is the time between two
    samples in seconds, or None if no clock is declared or if the clock varies (``clock_varies``).
    """

    traces: tuple[LabelledTrace, ...]
    counterexamples: tuple[LabelledTrace, ...]
    made_up: bool = False
    clock_s: float | None = None
    clock_varies: bool = False

    @property
    def all(self) -> tuple[LabelledTrace, ...]:
        """The traces, then the counterexamples."""
        return (*self.traces, *self.counterexamples)

    def atoms(self) -> tuple[str, ...]:
        """Return the atoms that hold at some sample, sorted by name."""
        return tuple(sorted({name for trace in self.all for letter in trace.letters for name in atoms_of(letter)}))
