"""Many traces at once, as whole numbers: a bit per sample, all traces of the evidence behind each other.

Each trace has a segment of the same whole number of bytes; its samples are the lowest bits, the first sample
lowest, and the highest bit is spare: carries and borrows of additions end there.  So a question about every
trace, such as "where does `a` hold for the first time?", takes a handful of operations on one number.
"""

from __future__ import annotations

from collections.abc import Sequence

from tltlc.tools.mine.evidence import Evidence, Recorded

Samples = int
"""A set of samples of all traces."""
Verdicts = int
"""A set of traces: a byte each, 0x80 where it is in the set."""


class Bits:
    """The evidence as masks.  ``backwards`` has the samples of each trace in the opposite order."""

    def __init__(self, evidence: Evidence, *, backwards: bool = False) -> None:
        traces = evidence.all
        longest = max(len(trace.letters) for trace in traces)
        self._bytes = longest // 8 + 1
        width = 8 * self._bytes
        self._low = sum(1 << width * number for number in range(len(traces)))
        self._top = self._low << (width - 1)
        self._carry = self._top - self._low
        self.all: Samples = self._mask(traces, None, backwards)
        self.holds: dict[str, Samples] = {name: self._mask(traces, name, backwards) for name in evidence.atoms()}
        self._length = len(traces)
        accepted = len(evidence.traces)
        self.traces: Verdicts = _set(0, accepted)
        self.counterexamples: Verdicts = _set(accepted, len(traces))
        self.everything: Verdicts = self.traces | self.counterexamples

    def _mask(self, traces: Sequence[Recorded], name: str | None, backwards: bool) -> Samples:
        """The samples at which an atom holds, or for None all that there are."""
        pieces = []
        for trace in traces:
            letters = reversed(trace.letters) if backwards else trace.letters
            # The digits of a number begin with the highest one.
            digits = "".join("1" if name is None or name in letter else "0" for letter in letters)[::-1]
            pieces.append(int(digits, 2).to_bytes(self._bytes, "little"))
        return int.from_bytes(b"".join(pieces), "little")

    def some(self, samples: Samples) -> Verdicts:
        """The traces with some of the samples."""
        tops = (samples + self._carry) & self._top
        return int.from_bytes(
            tops.to_bytes(self._bytes * self._length, "little")[self._bytes - 1 :: self._bytes], "little"
        )

    def none(self, samples: Samples) -> Verdicts:
        """The traces with none of the samples."""
        return self.everything & ~self.some(samples)

    def complement(self, samples: Samples) -> Samples:
        """All other samples."""
        return self.all & ~samples

    def after_first(self, samples: Samples) -> Samples:
        """The samples strictly after the first of the given ones; none where a trace has none of them."""
        return self.all & ~self._up_to_first(samples)

    def before_first(self, samples: Samples) -> Samples:
        """The samples strictly before the first of the given ones; all where a trace has none of them."""
        return self.all & self._up_to_first(samples) & ~samples

    def within(self, samples: Samples, steps: int) -> Samples:
        """The samples from which one of the given ones is at most so many steps away."""
        found = samples
        reached = 0
        while reached < steps:
            further = min(reached + 1, steps - reached)
            found |= self._earlier(found, further)
            reached += further
        return found

    def _earlier(self, samples: Samples, steps: int) -> Samples:
        """The samples that are so many steps earlier than the given ones."""
        start = self._start(steps)
        return (samples & ~start) >> steps

    def _start(self, steps: int) -> Samples:
        """The first so many samples of each trace."""
        width = 8 * self._bytes
        return self._low * ((1 << min(steps, width)) - 1)

    def _up_to_first(self, samples: Samples) -> Samples:
        marked = samples | self._top
        return marked ^ (marked - self._low)


def count(verdicts: Verdicts) -> int:
    """How many traces a set has."""
    return verdicts.bit_count()


def _set(first: int, end: int) -> Verdicts:
    return int.from_bytes(b"\0" * first + b"\x80" * (end - first), "little")
