"""Masks: a mask is a set of samples from all traces, as one integer with a bit for each sample.

So a question about every trace, such as "where does `a` hold for the first time?", takes a few
operations on one integer. The integer has a segment of bits for each trace, and all segments have
the same number of bytes. The lowest bit of a segment is for the first sample of its trace. The
highest bit belongs to no sample, so that carries and borrows do not reach the next segment.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from tltlc.tools.mine.evidence import Evidence, LabelledTrace

SampleMask = int
"""A set of samples of the traces: one bit for each sample."""
TraceMask = int
"""A set of traces: one byte for each trace, 0x80 if the trace is in the set, else 0."""


class Bits:
    """Recorded traces and counterexamples as bit masks.

    With ``backwards``, the samples of each trace are in reverse order.

    ``all`` has all samples, and ``holds`` the samples at which each atom holds, by atom. The sets
    of traces are ``traces`` (to be accepted), ``counterexamples`` (to be rejected), and
    ``all_traces``. ``longest`` is the greatest number of samples of a trace.
    """

    def __init__(self, evidence: Evidence, *, backwards: bool = False) -> None:
        traces = evidence.all
        self.longest = max(len(trace.letters) for trace in traces)
        self._bytes = self.longest // 8 + 1
        width = 8 * self._bytes
        self._low = sum(1 << width * number for number in range(len(traces)))
        self._top = self._low << (width - 1)
        self._carry = self._top - self._low
        self.all: SampleMask = self._mask(traces, None, backwards)
        self.holds: dict[str, SampleMask] = {name: self._mask(traces, name, backwards) for name in evidence.atoms()}
        self._length = len(traces)
        accepted = len(evidence.traces)
        self.traces: TraceMask = _set(0, accepted)
        self.counterexamples: TraceMask = _set(accepted, len(traces))
        self.all_traces: TraceMask = self.traces | self.counterexamples

    def _mask(self, traces: Sequence[LabelledTrace], name: str | None, backwards: bool) -> SampleMask:
        """Return the samples at which the atom ``name`` holds; all samples if ``name`` is None."""
        segments = []
        for trace in traces:
            letters = reversed(trace.letters) if backwards else trace.letters
            # The first digit of a number is the highest one.
            digits = "".join("1" if name is None or name in letter else "0" for letter in letters)[::-1]
            segments.append(int(digits, 2).to_bytes(self._bytes, "little"))
        return int.from_bytes(b"".join(segments), "little")

    def traces_with(self, samples: SampleMask) -> TraceMask:
        """Return the traces that contain at least one of the samples."""
        tops = (samples + self._carry) & self._top
        return int.from_bytes(
            tops.to_bytes(self._bytes * self._length, "little")[self._bytes - 1 :: self._bytes], "little"
        )

    def traces_without(self, samples: SampleMask) -> TraceMask:
        """Return the traces that contain none of the samples."""
        return self.all_traces & ~self.traces_with(samples)

    def complement(self, samples: SampleMask) -> SampleMask:
        """Return all samples that are not in the set."""
        return self.all & ~samples

    def after_first(self, samples: SampleMask) -> SampleMask:
        """Return the samples of each trace that come after its first sample in ``samples``.

        A trace that has none of ``samples`` adds no sample to the result.
        """
        return self.all & ~self._up_to_first(samples)

    def before_first(self, samples: SampleMask) -> SampleMask:
        """Return the samples of each trace that come before its first sample in ``samples``.

        A trace that has none of ``samples`` adds all of its samples to the result.
        """
        return self.all & self._up_to_first(samples) & ~samples

    def within(self, samples: SampleMask, steps: int) -> SampleMask:
        """Return ``samples``, and all samples at most ``steps`` steps before one of them in the same trace."""
        result = samples
        reached = 0
        while reached < steps:
            shift = min(reached + 1, steps - reached)
            result |= self.earlier(result, shift)
            reached += shift
        return result

    def lasting(self, samples: SampleMask, steps: int) -> SampleMask:
        """Return the samples that are in the set together with the next ``steps`` samples of their trace."""
        result = samples
        reached = 0
        while reached < steps:
            shift = min(reached + 1, steps - reached)
            result &= self.earlier(result, shift)
            reached += shift
        return result

    def firsts(self, samples: SampleMask) -> SampleMask:
        """Return the first sample of each run of consecutive samples in the set."""
        return samples & ~(samples << 1)

    def lasts(self, samples: SampleMask) -> SampleMask:
        """Return the last sample of each run of consecutive samples in the set."""
        return samples & ~self.earlier(samples, 1)

    def positions(self, samples: SampleMask) -> list[tuple[int, int]]:
        """Return the samples of a set in order, each as the number of its trace and its number in the trace."""
        text = bin(samples)[:1:-1]
        result = []
        place = text.find("1")
        while place >= 0:
            result.append(divmod(place, 8 * self._bytes))
            place = text.find("1", place + 1)
        return result

    def counts(self, samples: SampleMask) -> list[int]:
        """Return how many of the samples each trace has, counterexamples last."""
        data = samples.to_bytes(self._bytes * self._length, "little")
        size = self._bytes
        return [int.from_bytes(data[start : start + size], "little").bit_count() for start in range(0, len(data), size)]

    def samples_of(self, traces: TraceMask) -> SampleMask:
        """Return all samples of these traces."""
        ends = traces.to_bytes(self._length, "little")
        whole, none = b"\xff" * self._bytes, b"\0" * self._bytes
        return self.all & int.from_bytes(b"".join(whole if end else none for end in ends), "little")

    def earlier(self, samples: SampleMask, steps: int) -> SampleMask:
        """Return the samples exactly ``steps`` steps before one of ``samples`` in the same trace."""
        start = self._start(steps)
        return (samples & ~start) >> steps

    def _start(self, steps: int) -> SampleMask:
        """Return the first ``steps`` samples of each trace."""
        width = 8 * self._bytes
        return self._low * ((1 << min(steps, width)) - 1)

    def _up_to_first(self, samples: SampleMask) -> SampleMask:
        """Return the bits of each trace up to and including its first sample in ``samples``.

        For a trace that has none of ``samples``, these are all of its bits.
        """
        with_end = samples | self._top
        return with_end ^ (with_end - self._low)


def count(verdicts: TraceMask) -> int:
    """Return the number of traces in a set."""
    return verdicts.bit_count()


def trace_set(members: Iterable[bool]) -> TraceMask:
    """Return the set of the traces for which ``members`` has true; it has an entry for each trace, in order."""
    return int.from_bytes(bytes(0x80 * member for member in members), "little")


def _set(first: int, end: int) -> TraceMask:
    """Return the set of the traces with numbers from ``first`` up to, but not including, ``end``."""
    return int.from_bytes(b"\0" * first + b"\x80" * (end - first), "little")
