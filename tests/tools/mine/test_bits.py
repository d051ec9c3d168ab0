"""Sets of samples and traces as integers agree with a naive implementation."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from tests.tools.mine.conftest import evidences
from tltlc.tools.mine.bits import Bits, count, trace_set
from tltlc.tools.mine.evidence import Evidence, LabelledTrace


def places(bits: Bits, samples: int, evidence: Evidence) -> list[set[int]]:
    """Return the samples of each trace in a set, decoded bit by bit."""
    decoded = []
    width = bits.all.bit_length() // len(evidence.all) + 8
    size = next(size for size in range(1, width) if _fits(bits, size, evidence))
    for number, trace in enumerate(evidence.all):
        segment = samples >> (8 * size * number)
        decoded.append({place for place in range(len(trace.letters)) if segment >> place & 1})
    return decoded


def _fits(bits: Bits, size: int, evidence: Evidence) -> bool:
    whole = sum(((1 << len(trace.letters)) - 1) << (8 * size * number) for number, trace in enumerate(evidence.all))
    return whole == bits.all and size == max(len(trace.letters) for trace in evidence.all) // 8 + 1


def members(bits: Bits, verdicts: int, evidence: Evidence) -> list[bool]:
    return [bool(verdicts >> (8 * number) & 0x80) for number in range(len(evidence.all))]


@given(evidences(), st.integers(0, 9))
def test_operations_match_a_naive_implementation(evidence: Evidence, steps: int) -> None:
    bits = Bits(evidence)
    for name, samples in bits.holds.items():
        naive = [{place for place, letter in enumerate(trace.letters) if name in letter} for trace in evidence.all]
        all_places = [set(range(len(trace.letters))) for trace in evidence.all]
        assert places(bits, samples, evidence) == naive
        assert members(bits, bits.traces_with(samples), evidence) == [
            bool(places_of_trace) for places_of_trace in naive
        ]
        assert members(bits, bits.traces_without(samples), evidence) == [
            not places_of_trace for places_of_trace in naive
        ]
        assert places(bits, bits.complement(samples), evidence) == [
            all_ - places_of_trace for all_, places_of_trace in zip(all_places, naive, strict=True)
        ]
        firsts = [min(places_of_trace, default=None) for places_of_trace in naive]
        assert places(bits, bits.after_first(samples), evidence) == [
            {place for place in all_ if first is not None and place > first}
            for all_, first in zip(all_places, firsts, strict=True)
        ]
        assert places(bits, bits.before_first(samples), evidence) == [
            {place for place in all_ if first is None or place < first}
            for all_, first in zip(all_places, firsts, strict=True)
        ]
        assert places(bits, bits.within(samples, steps), evidence) == [
            {place for place in all_ if any(place <= later <= place + steps for later in places_of_trace)}
            for all_, places_of_trace in zip(all_places, naive, strict=True)
        ]
        assert places(bits, bits.lasting(samples, steps), evidence) == [
            {place for place in places_of_trace if places_of_trace.issuperset(range(place, place + steps + 1))}
            for places_of_trace in naive
        ]
        assert places(bits, bits.firsts(samples), evidence) == [
            {place for place in places_of_trace if place - 1 not in places_of_trace} for places_of_trace in naive
        ]
        assert places(bits, bits.lasts(samples), evidence) == [
            {place for place in places_of_trace if place + 1 not in places_of_trace} for places_of_trace in naive
        ]
        assert bits.positions(samples) == [
            (number, place) for number, places_of_trace in enumerate(naive) for place in sorted(places_of_trace)
        ]
        assert bits.counts(samples) == [len(places_of_trace) for places_of_trace in naive]
        some = trace_set(len(places_of_trace) == 1 for places_of_trace in naive)
        assert places(bits, bits.samples_of(some), evidence) == [
            all_ if len(places_of_trace) == 1 else set()
            for all_, places_of_trace in zip(all_places, naive, strict=True)
        ]


@given(evidences())
def test_backwards_reverses_every_trace(evidence: Evidence) -> None:
    reversed_evidence = Evidence(
        *(
            tuple(LabelledTrace(trace.name, trace.letters[::-1]) for trace in part)
            for part in (evidence.traces, evidence.counterexamples)
        )
    )
    assert Bits(evidence, backwards=True).holds == Bits(reversed_evidence).holds


@given(evidences())
def test_traces_and_counterexamples_partition_the_evidence(evidence: Evidence) -> None:
    bits = Bits(evidence)
    assert count(bits.traces) == len(evidence.traces)
    assert count(bits.counterexamples) == len(evidence.counterexamples)
    assert bits.traces & bits.counterexamples == 0
