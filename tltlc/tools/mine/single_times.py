"""Candidate clauses about one atom: how often it begins to hold, and for how long it holds.

Each has the number, or the round time, that enough traces meet. A clause is left out if the traces are
likely to meet it by chance (:mod:`tltlc.tools.mine.chance`).
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from math import prod

from tltlc.tools.mine.bits import Bits, SampleMask, TraceMask, trace_set
from tltlc.tools.mine.chance import no_more
from tltlc.tools.mine.clause import MinedClause
from tltlc.tools.mine.templates import COUNT, GOAL_TIME, LONGEST, SHORTEST, template_clause
from tltlc.tools.mine.timed_evidence import TimedEvidence, intervals
from tltlc.tools.witness.blocks import atom_operand


def single_times(evidence: TimedEvidence, events: Collection[str]) -> Iterator[list[MinedClause]]:
    """Yield the clauses about the counts and times of each atom in ``events``, in portions."""
    events = [name for name in events if name in evidence.good.holds]
    for name in events:
        portion = [*_count(name, evidence, len(events))]
        # A clock that varies takes no bounds in steps.
        if not evidence.clock_varies:
            portion += _shortest(name, evidence, len(events))
        if evidence.clock_s is not None:
            portion += [*_longest(name, evidence, len(events)), *_goal(name, evidence, len(events))]
        yield portion


def _count(name: str, evidence: TimedEvidence, tried: int) -> Iterator[MinedClause]:
    """Yield ``keep times(NAME) <= N``, or nothing."""
    good = evidence.good
    begins = good.firsts(good.holds[name])
    counts = good.counts(begins)

    def accepted(bits: Bits, most: int) -> TraceMask:
        return trace_set(number <= most for number in bits.counts(bits.firsts(bits.holds[name])))

    most = evidence.smallest(accepted, 0, max(counts))
    if not most:
        return
    accepts = accepted(evidence.all, most)

    def chance() -> float:
        events = good.positions(begins & good.samples_of(accepted(good, most)))
        lasts = dict(events)  # The last one of each trace.
        lengths = good.counts(good.all)
        quiet = [lengths[trace] - 1 - sample for trace, sample in lasts.items() if counts[trace] == most]
        return no_more(intervals(events), quiet)

    if evidence.is_real(accepts, chance, tried):
        yield template_clause(COUNT, f"keep times({name}) <= {most}", 2, accepts, _occurs(name, evidence))


def _longest(name: str, evidence: TimedEvidence, tried: int) -> Iterator[MinedClause]:
    """Yield ``keep time_holding(NAME) <= T``, or nothing."""
    good = evidence.good

    def accepted(bits: Bits, most: int) -> TraceMask:
        return bits.traces_without(bits.lasting(bits.holds[name], most + 1))

    most = evidence.smallest(accepted, 1, good.longest - 1)
    if most is None:
        return
    time = evidence.times.above(most)

    def chance() -> float:
        stay, ended = _stay(good.holds[name] & good.samples_of(accepted(good, time.steps)), good)
        return (1.0 - stay ** (most + 1)) ** ended

    if time.is_seconds and time.steps < evidence.all.longest:
        accepts = accepted(evidence.all, time.steps)
        if evidence.is_real(accepts, chance, tried):
            text = f"keep time_holding({name}) <= {time.text}"
            yield template_clause(LONGEST, text, 2, accepts, _occurs(name, evidence))


def _shortest(name: str, evidence: TimedEvidence, tried: int) -> Iterator[MinedClause]:
    """Yield ``keep begins NAME implies always for T NAME``, or nothing."""
    good = evidence.good

    def accepted(bits: Bits, fewest: int) -> TraceMask:
        samples = bits.holds[name]
        return bits.traces_without(bits.firsts(samples) & bits.within(bits.complement(samples), fewest - 1))

    fewest = evidence.greatest(accepted, 2, good.longest)
    if fewest is None or fewest == good.longest:
        return
    time = evidence.times.below(fewest)

    def chance() -> float:
        stay, ended = _stay(good.holds[name] & good.samples_of(accepted(good, fewest)), good)
        return stay ** ((fewest - 1) * ended)

    accepts = accepted(evidence.all, time.steps)
    if time.steps > 1 and evidence.is_real(accepts, chance, tried):
        operand = atom_operand(name)
        text = f"keep begins {operand} implies always for {time.text} {operand}"
        yield template_clause(SHORTEST, text, 3, accepts, _occurs(name, evidence))


def _goal(name: str, evidence: TimedEvidence, tried: int) -> Iterator[MinedClause]:
    """Yield ``reach time_holding(NAME) >= T``, or nothing."""
    good = evidence.good

    def accepted(bits: Bits, fewest: int) -> TraceMask:
        return bits.traces_with(bits.lasting(bits.holds[name], fewest))

    fewest = evidence.greatest(accepted, 2, good.longest - 1)
    if fewest is None:
        return
    time = evidence.times.below(fewest)

    def chance() -> float:
        samples = good.holds[name] & good.samples_of(accepted(good, fewest))
        stay, _ = _stay(samples, good)
        return prod(1.0 - (1.0 - stay**fewest) ** number for number in good.counts(good.firsts(samples)) if number)

    accepts = accepted(evidence.all, time.steps)
    if time.is_seconds and evidence.is_real(accepts, chance, tried):
        text = f"reach time_holding({name}) >= {time.text}"
        yield template_clause(GOAL_TIME, text, 2, accepts, evidence.all.all_traces)


def _occurs(name: str, evidence: TimedEvidence) -> TraceMask:
    return evidence.all.traces_with(evidence.all.holds[name])


def _stay(samples: SampleMask, bits: Bits) -> tuple[float, int]:
    """Return the probability that an atom goes on holding, and how often it has ended.

    ``samples`` are those at which it holds. A run that lasts until the end of its trace has not ended.
    """
    goes_on = bits.earlier(bits.all, 1)
    may_end = (samples & goes_on).bit_count()
    ended = (bits.lasts(samples) & goes_on).bit_count()
    return (1.0 - ended / may_end if may_end else 1.0), ended
