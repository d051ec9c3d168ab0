"""Search for specs: clauses from templates, then sequences of goals, then conjunctions of clauses.

The caller can stop the search at any time and use the best results so far.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import chain
from math import ceil

from tltlc.automaton.work import Work
from tltlc.core.record import record
from tltlc.io.limits import WORK
from tltlc.tools.mine.bits import Bits, count
from tltlc.tools.mine.candidates import Candidates
from tltlc.tools.mine.clause import Conjunction, MinedClause, accepted_traces, count_atoms
from tltlc.tools.mine.conjunctions import best_candidates, conjunctions
from tltlc.tools.mine.events import MOST_EVENTS, best_events
from tltlc.tools.mine.evidence import Evidence
from tltlc.tools.mine.pair_times import pair_times
from tltlc.tools.mine.score import figures
from tltlc.tools.mine.sequences import sequences
from tltlc.tools.mine.single_times import single_times
from tltlc.tools.mine.templates import clauses
from tltlc.tools.mine.timed_evidence import TimedEvidence


@record
class MiningOptions:
    """Options of a search.

    ``min_support`` is the least share of the traces that must satisfy a proposal, in (0, 1].
    ``max_length`` is the greatest length of a proposal: the number of its atoms, where each occurrence
    counts. A bound, as in `within 3 steps`, counts as one atom more, and so does each `and` or `or`
    in an event of `reach a then (b and c)`.
    """

    min_support: float = 1.0
    max_length: int = 12


class SpecSearch:
    """Searches for specs that the traces satisfy and the counterexamples violate.

    :meth:`run` searches, and :meth:`ranking` returns what has been found so far. ``tried_count`` is
    the number of candidates that have been tried so far, and ``bits`` has the evidence as bit masks.
    """

    def __init__(self, evidence: Evidence, options: MiningOptions) -> None:
        self.bits = Bits(evidence)
        self._backwards = Bits(evidence, backwards=True)
        # Even atoms that change at random have some order, and generated counterexamples always break it.
        # Sequences with repeated steps would only fit that order.
        self._allow_repeats = not evidence.made_up
        # Round first, so that a rounding error does not require one trace more than the share.
        self._least = max(1, ceil(round(options.min_support * len(evidence.traces), 9)))
        self._most_atoms = options.max_length
        self._candidates = Candidates(self.bits)
        self._evidence = evidence
        self._work = Work(WORK["mined sequences"])
        self._times_work = Work(WORK["mined times"])
        self._unrelated = 0
        self.tried_count = 0

    def run(self) -> Iterator[str]:
        """Run the search, and yield the name of the current phase many times a second.

        The caller may stop the iteration at any time.
        """
        events = self._chosen_events()
        timed = TimedEvidence(self._evidence, self.bits, self._least)
        times = single_times(timed, events)
        if not self._evidence.clock_varies:
            times = chain(times, pair_times(timed, events, self._times_work))
        untimed = clauses(self.bits, self._backwards, events)
        for number, portion in enumerate(chain(untimed, times)):
            self._add_all(clause for clause in portion if clause.atoms <= self._most_atoms)
            if number % 20 == 0:
                yield "templates"
        for portion in sequences(
            self.bits, events, self._least, self._most_atoms, allow_repeats=self._allow_repeats, work=self._work
        ):
            self._add_all(portion)
            yield "sequences"
        singles = [conjunction[0] for conjunction, _ in best_candidates(self._candidates.items(), self.bits)]
        for batch in conjunctions(singles, self.bits, self._least, self._most_atoms):
            self.tried_count += len(batch)
            for conjunction in batch:
                self._candidates.add(conjunction, accepted_traces(conjunction, self.bits))
            yield "conjunctions"

    def ranking(self) -> list[Conjunction]:
        """Return the conjunctions found so far, the best first.

        A conjunction is left out if no counterexample violates it, or if another conjunction has a
        better score and no more atoms.
        """
        ranked: list[tuple[float, int, Conjunction]] = []
        for conjunction, accepts in best_candidates(self._candidates.items(), self.bits):
            size = count_atoms(conjunction)
            support = figures(self.bits, accepts)
            rank = (support.score(size), size)
            if support.rejected and (not ranked or size < ranked[-1][1] or rank == ranked[-1][:2]):
                ranked.append((*rank, conjunction))
        return [conjunction for _, _, conjunction in ranked]

    def omissions(self) -> list[str]:
        """Return a sentence for each limit on work that made the search leave something out."""
        sentences = []
        if self._unrelated:
            others = "1 other is" if self._unrelated == 1 else f"{self._unrelated:,} others are"
            sentences.append(f"only {MOST_EVENTS} atoms are related to each other, and {others} not")
        if self._work.left < 0:
            sentences.append(f"only sequences of {WORK['mined sequences']:,} steps in total are tried, others are not")
        if self._times_work.left < 0:
            sentences.append("times between atoms are tried only for some pairs of atoms")
        if self._candidates.is_cut:
            sentences.append(f"only the {WORK['mined candidates']:,} candidates with the best scores are kept")
        return sentences

    def _chosen_events(self) -> list[str]:
        """Return the atoms from which pairs and sequences are built, and store how many are left out."""
        events = self._events()
        chosen = best_events(self._evidence, events)
        self._unrelated = len(events) - len(chosen)
        return chosen

    def _events(self) -> list[str]:
        """Return the atoms without those that hold at every sample of enough traces.

        For the atoms that are left out, the clause `keep ATOM` says all that is needed.
        """
        bits = self.bits
        return [
            name
            for name, samples in bits.holds.items()
            if count(bits.traces_without(bits.complement(samples)) & bits.traces) < self._least
        ]

    def _add_all(self, portion: Iterable[MinedClause]) -> None:
        for clause in portion:
            self._add(clause)

    def _add(self, clause: MinedClause) -> None:
        self.tried_count += 1
        if count(clause.accepts & self.bits.traces) >= self._least and self.bits.counterexamples & ~clause.accepts:
            self._candidates.add((clause,), clause.accepts)
