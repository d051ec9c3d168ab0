"""Candidate clauses about the time between two atoms: an answer in time, a sequence in time, and a pause.

Each has the least or greatest round time that enough traces meet with room. A clause is left out if
the traces are likely to meet it by chance (:mod:`tltlc.tools.mine.chance`), or if another clause of the
same template says more.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from math import prod

from tltlc.automaton.work import OutOfWork, Work
from tltlc.core.record import record
from tltlc.tools.mine.bits import Bits, TraceMask
from tltlc.tools.mine.chance import all_at_least, all_at_most
from tltlc.tools.mine.clause import MinedClause
from tltlc.tools.mine.templates import BOUNDED, IN_TIME, PAUSE, template_clause
from tltlc.tools.mine.timed_evidence import TimedEvidence, gaps, share
from tltlc.tools.witness.blocks import atom_operand


@record
class _PairTime:
    """A clause about the time from ``first`` to ``second``, in steps."""

    first: str
    second: str
    steps: int
    clause: MinedClause


def pair_times(evidence: TimedEvidence, events: Collection[str], work: Work) -> Iterator[list[MinedClause]]:
    """Yield the clauses about the time between two atoms of ``events``, in portions.

    Many portions are empty: they only give the caller a chance to stop the search. A pair costs as many
    steps of ``work`` as there are samples. When the work is used up, no further pairs are tried.
    """
    events = [name for name in events if name in evidence.good.holds]
    pairs = [(first, second) for first in events for second in events if first != second]
    search = _PairTimes(evidence, len(pairs))
    answers: list[_PairTime] = []
    sequences: list[_PairTime] = []
    pauses: list[_PairTime] = []
    cost = evidence.good.all.bit_count()
    for first, second in pairs:
        try:
            work.spend(cost)
        except OutOfWork:
            break
        answers += search.answer(first, second)
        sequences += search.sequence(first, second)
        pauses += search.pause(first, second)
        yield []
    kept = search.strongest_answers(answers)
    yield [time.clause for time in kept]
    known = {(time.first, time.second): time.steps for time in kept}
    yield [time.clause for time in sequences if known.get((time.first, time.second), time.steps + 1) > time.steps]
    yield [time.clause for time in search.strongest_pauses(pauses)]


class _PairTimes:
    def __init__(self, evidence: TimedEvidence, tried: int) -> None:
        self._evidence, self._tried = evidence, tried

    def answer(self, first: str, second: str) -> Iterator[_PairTime]:
        """Yield ``keep FIRST implies eventually within T SECOND``, or nothing."""
        evidence, good = self._evidence, self._evidence.good

        def answered(bits: Bits, steps: int) -> TraceMask:
            return bits.traces_without(bits.holds[first] & ~bits.within(bits.holds[second], steps))

        most = evidence.smallest(answered, 0, good.longest - 1)
        if not most:
            return
        time = evidence.times.above(most)

        def chance() -> float:
            a, b = good.holds[first], good.holds[second]
            inside = good.samples_of(answered(good, time.steps))
            requests = good.firsts(a) & inside
            in_time = good.within(b, most)
            # Near the end of a trace, it is not known whether an answer would have come in time.
            known = inside & (in_time | good.earlier(good.all, most))
            by_rate = share(in_time, known) ** requests.bit_count()
            later = gaps(good.positions(requests & ~b), good.positions(good.firsts(b)))
            delays = [0] * (requests & b).bit_count() + [delay for _, delay in later]
            return max(by_rate, all_at_most(delays, max(delays), 0))

        if time.steps < evidence.all.longest and answered(good, time.steps) & good.traces_with(good.holds[first]):
            text = f"keep {atom_operand(first)} implies eventually within {time.text} {atom_operand(second)}"
            triggered = evidence.all.traces_with(evidence.all.holds[first])
            clause = template_clause(BOUNDED, text, 3, answered(evidence.all, time.steps), triggered)
            if evidence.is_real(clause.accepts, chance, self._tried):
                yield _PairTime(first, second, time.steps, clause)

    def sequence(self, first: str, second: str) -> Iterator[_PairTime]:
        """Yield ``reach FIRST then within T SECOND``, or nothing."""
        evidence, good = self._evidence, self._evidence.good

        def met(bits: Bits, steps: int) -> TraceMask:
            return bits.traces_with(bits.holds[first] & bits.earlier(bits.within(bits.holds[second], steps - 1), 1))

        most = evidence.smallest(met, 1, good.longest - 1)
        if most is None:
            return
        time = evidence.times.above(most)

        def chance() -> float:
            a, b = good.holds[first], good.holds[second]
            inside = good.samples_of(met(good, time.steps))
            in_time = good.earlier(good.within(b, most - 1), 1)
            rate = share(in_time, inside & (in_time | good.earlier(good.all, most)))
            requests = good.counts(good.firsts(a) & inside)
            by_rate = prod(1.0 - (1.0 - rate) ** number for number in requests if number)
            # The shortest gap of a trace begins at the end of a run, unless both hold at once.
            best: dict[int, int] = {trace: 1 for trace, _ in good.positions(a & good.earlier(b, 1) & inside)}
            for trace, gap in gaps(good.positions(good.lasts(a) & inside), good.positions(good.firsts(b))):
                best[trace] = min(best.get(trace, gap), gap)
            delays = list(best.values())
            return max(by_rate, all_at_most(delays, max(delays), 1))

        if time.steps < evidence.all.longest:
            accepts = met(evidence.all, time.steps)
            if evidence.is_real(accepts, chance, self._tried):
                text = f"reach {atom_operand(first)} then within {time.text} {atom_operand(second)}"
                clause = template_clause(IN_TIME, text, 3, accepts, evidence.all.all_traces)
                yield _PairTime(first, second, time.steps, clause)

    def pause(self, first: str, second: str) -> Iterator[_PairTime]:
        """Yield ``keep FIRST implies always for T not SECOND``, or nothing."""
        evidence, good = self._evidence, self._evidence.good

        def quiet(bits: Bits, steps: int) -> TraceMask:
            return bits.traces_without(bits.holds[first] & bits.within(bits.holds[second], steps - 1))

        most = evidence.greatest(quiet, 2, good.longest)
        # If no second ever comes after the first, no time is too long.
        if most is None or most == good.longest:
            return
        time = evidence.times.below(most)

        def chance() -> float:
            a, b = good.holds[first], good.holds[second]
            inside = good.samples_of(quiet(good, most))
            requests = good.lasts(a) & inside
            soon = good.within(b, most - 1)
            known = inside & (soon | good.earlier(good.all, most - 1))
            by_rate = share(~soon, known) ** (requests & known).bit_count()
            lengths = [gap for _, gap in gaps(good.positions(requests), good.positions(good.firsts(b)))]
            return max(by_rate, all_at_least(lengths, most, 1)) if lengths else 1.0

        if time.steps > 1 and quiet(good, time.steps) & good.traces_with(good.holds[first]):
            text = f"keep {atom_operand(first)} implies always for {time.text} not {atom_operand(second)}"
            triggered = evidence.all.traces_with(evidence.all.holds[first])
            clause = template_clause(PAUSE, text, 3, quiet(evidence.all, time.steps), triggered)
            if evidence.is_real(clause.accepts, chance, self._tried):
                yield _PairTime(first, second, time.steps, clause)

    def strongest_answers(self, answers: list[_PairTime]) -> list[_PairTime]:
        """Leave out each answer that follows from shorter ones.

        If each A is followed by a B within 2 s, and each B by a C within 3 s, then each A by a C within 5 s.
        """
        kept: dict[tuple[str, str], _PairTime] = {}
        for time in sorted(answers, key=lambda time: (time.steps, time.clause.text)):
            nearer = [other for other in kept.values() if other.second == time.second]
            chains = [(kept.get((time.first, other.first)), other) for other in nearer]
            if not any(self._implies(time, other) for other in nearer) and not any(
                before is not None and before.steps + after.steps <= time.steps for before, after in chains
            ):
                kept[time.first, time.second] = time
        return list(kept.values())

    def strongest_pauses(self, pauses: list[_PairTime]) -> list[_PairTime]:
        """Leave out each pause that follows from another, longer one."""
        kept: list[_PairTime] = []
        for time in sorted(pauses, key=lambda time: (-time.steps, time.clause.text)):
            if not any(other.second == time.second and self._implies(time, other) for other in kept):
                kept.append(time)
        return kept

    def _implies(self, time: _PairTime, other: _PairTime) -> bool:
        """Whether the first atom of ``time`` implies that of ``other``, in all traces that accept ``time``."""
        good = self._evidence.good
        together = good.traces_without(good.holds[time.first] & ~good.holds[other.first])
        return not time.clause.accepts & good.traces & ~together
