"""The search: templates, sequences, conjunctions; it can be left at any moment with what is best so far."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import ceil

from tltlc.automaton.infinite.work import Work
from tltlc.core.record import record
from tltlc.io.limits import WORK
from tltlc.tools.mine.bits import Bits, count
from tltlc.tools.mine.candidates import Candidates
from tltlc.tools.mine.clause import Clause, Conjunction, accepted_by, atoms_of
from tltlc.tools.mine.conjunctions import best, conjunctions
from tltlc.tools.mine.events import MOST_EVENTS, best_events
from tltlc.tools.mine.evidence import Evidence
from tltlc.tools.mine.measure import figures
from tltlc.tools.mine.sequences import sequences
from tltlc.tools.mine.templates import clauses


@record
class Options:
    """``min_support``: the least share of the traces that a proposal is to be satisfied by, in (0, 1].

    ``max_length``: how many atoms a proposal may name, a bound counting as one.
    """

    min_support: float = 1.0
    max_length: int = 12


class Search:
    """Looks for specs that the traces satisfy and the counterexamples violate."""

    def __init__(self, evidence: Evidence, options: Options) -> None:
        self.bits = Bits(evidence)
        self._backwards = Bits(evidence, backwards=True)
        # Atoms that come and go by chance do so in some order, which made-up counterexamples are sure to break.
        self._again = not evidence.made_up
        # Rounding must not ask for one trace more than the share says.
        self._least = max(1, ceil(round(options.min_support * len(evidence.traces), 9)))
        self._most_atoms = options.max_length
        self._found = Candidates(self.bits)
        self._evidence = evidence
        self._work = Work(WORK["mined sequences"])
        self._unrelated = 0
        self.tried = 0

    def run(self) -> Iterator[str]:
        """Search on; what is being done, many times a second, so that whoever asks may leave off."""
        events = self._chosen_events()
        for number, portion in enumerate(clauses(self.bits, self._backwards, events, self._least)):
            self._add_all(each for each in portion if each.atoms <= self._most_atoms)
            if number % 20 == 0:
                yield "templates"
        for portion in sequences(self.bits, events, self._least, self._most_atoms, again=self._again, work=self._work):
            self._add_all(portion)
            yield "sequences"
        singles = [conjunction[0] for conjunction, _ in best(self._found.items(), self.bits)]
        for wholes in conjunctions(singles, self.bits, self._least, self._most_atoms):
            self.tried += len(wholes)
            for conjunction in wholes:
                self._found.add(conjunction, accepted_by(conjunction, self.bits))
            yield "conjunctions"

    def ranked(self) -> list[Conjunction]:
        """What was found so far, the best first: each is the best of all that are not longer.

        What no counterexample violates is left out, and what is longer than something better.
        """
        found: list[tuple[float, int, Conjunction]] = []
        for conjunction, accepts in best(self._found.items(), self.bits):
            size = atoms_of(conjunction)
            said = figures(self.bits, accepts)
            place = (said.score(size), size)
            if said.rejected and (not found or size < found[-1][1] or place == found[-1][:2]):
                found.append((*place, conjunction))
        return [conjunction for _, _, conjunction in found]

    def left_out(self) -> list[str]:
        """What the limits on work left out, a sentence each."""
        said = []
        if self._unrelated:
            said.append(f"only {MOST_EVENTS} atoms are related to each other, and {self._unrelated:,} others are not")
        if self._work.left < 0:
            said.append(f"only sequences of {WORK['mined sequences']:,} steps together are tried, others are not")
        if self._found.is_cut:
            said.append(f"only the {WORK['mined candidates']:,} candidates with the best scores are kept")
        return said

    def _chosen_events(self) -> list[str]:
        """The events that are related to each other."""
        events = self._events()
        chosen = best_events(self._evidence, events)
        self._unrelated = len(events) - len(chosen)
        return chosen

    def _events(self) -> list[str]:
        """The atoms that do not hold throughout as many traces as have to satisfy a proposal."""
        bits = self.bits
        return [
            name
            for name, samples in bits.holds.items()
            if count(bits.none(bits.complement(samples)) & bits.traces) < self._least
        ]

    def _add_all(self, several: Iterable[Clause]) -> None:
        for each in several:
            self._add(each)

    def _add(self, each: Clause) -> None:
        self.tried += 1
        if count(each.accepts & self.bits.traces) >= self._least and self.bits.counterexamples & ~each.accepts:
            self._found.add((each,), each.accepts)
