"""All traces at once, as one integer: a bit per sample, with the traces of the evidence in a row.

Each trace has a segment of the same number of whole bytes. Its samples are the lowest bits, the
first sample lowest. The highest bit is spare: carries and borrows of additions end there. So a
question about every trace, such as "where does `a` hold for the first time?", takes a few
operations on one number.
"""

from __future__ import annotations

from collections.abc import Sequence

from tltlc.tools.mine.evidence import Evidence, LabelledTrace

Samples = int
"""A set of samples of all traces."""
Verdicts = int
"""A set of traces: one byte per trace, 0x80 if it is in the set."""


class Bits:
    """The evidence as masks. ``backwards`` reverses the order of samples in each trace."""

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

    def _mask(self, traces: Sequence[LabelledTrace], name: str | None, backwards: bool) -> Samples:
        """Return the samples at which an atom holds, or all samples for None."""
        pieces = []
        for trace in traces:
            letters = reversed(trace.letters) if backwards else trace.letters
            # The first digit of a number is the highest one.
            digits = "".join("1" if name is None or name in letter else "0" for letter in letters)[::-1]
            pieces.append(int(digits, 2).to_bytes(self._bytes, "little"))
        return int.from_bytes(b"".join(pieces), "little")

    def some(self, samples: Samples) -> Verdicts:
        """Return the traces that contain some of the samples."""
        tops = (samples + self._carry) & self._top
        return int.from_bytes(
            tops.to_bytes(self._bytes * self._length, "little")[self._bytes - 1 :: self._bytes], "little"
        )

    def none(self, samples: Samples) -> Verdicts:
        """Return the traces that contain none of the samples."""
        return self.everything & ~self.some(samples)

    def complement(self, samples: Samples) -> Samples:
        """Return all other samples."""
        return self.all & ~samples

    def after_first(self, samples: Samples) -> Samples:
        """Return the samples strictly after the first given one; none in a trace without a given one."""
        return self.all & ~self._up_to_first(samples)

    def before_first(self, samples: Samples) -> Samples:
        """Return the samples strictly before the first given one; all in a trace without a given one."""
        return self.all & self._up_to_first(samples) & ~samples

    def within(self, samples: Samples, steps: int) -> Samples:
        """Return the samples that are at most ``steps`` before one of the given samples, or equal to one."""
        result = samples
        reached = 0
        while reached < steps:
            shift = min(reached + 1, steps - reached)
            result |= self._earlier(result, shift)
            reached += shift
        return result

    def _earlier(self, samples: Samples, steps: int) -> Samples:
        """Return the samples that are ``steps`` before the given ones."""
        start = self._start(steps)
        return (samples & ~start) >> steps

    def _start(self, steps: int) -> Samples:
        """Return the first ``steps`` samples of each trace."""
        width = 8 * self._bytes
        return self._low * ((1 << min(steps, width)) - 1)

    def _up_to_first(self, samples: Samples) -> Samples:
        marked = samples | self._top
        return marked ^ (marked - self._low)


def count(verdicts: Verdicts) -> int:
    """Return the number of traces in a set."""
    return verdicts.bit_count()


def _set(first: int, end: int) -> Verdicts:
    return int.from_bytes(b"\0" * first + b"\x80" * (end - first), "little")
