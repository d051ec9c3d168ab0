"""What the templates about times and counts ask of the traces: which bound they meet, and whether by chance."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise

from tltlc.core.record import replace
from tltlc.tools.mine.bits import Bits, SampleMask, TraceMask, count
from tltlc.tools.mine.chance import LEVEL, separated
from tltlc.tools.mine.evidence import Evidence
from tltlc.tools.mine.round_times import RoundTimes

AcceptedWith = Callable[[Bits, int], TraceMask]
"""Returns the traces that satisfy a clause with this number or time, in steps."""


class TimedEvidence:
    """The traces and counterexamples as bit masks (``all``), the traces alone (``good``), and the choice of bounds.

    At least ``least`` traces must meet a bound. ``times`` are the round times, and ``clock_s`` is the
    time between two samples, None without a clock. If the counterexamples are made up, they do not
    show that a bound is real.
    """

    def __init__(self, evidence: Evidence, bits: Bits, least: int) -> None:
        self.all, self.least, self.clock_s = bits, least, evidence.clock_s
        self.clock_varies = evidence.clock_varies
        self.good = Bits(replace(evidence, counterexamples=()))
        self.times = RoundTimes(evidence.clock_s)
        self._made_up = evidence.made_up

    def smallest(self, accepted: AcceptedWith, low: int, high: int) -> int | None:
        """Return the smallest number from ``low`` to ``high`` with which enough traces are accepted, or None.

        A greater number accepts the same traces, or more.
        """

        def is_enough(number: int) -> bool:
            return count(accepted(self.good, number)) >= self.least

        if low > high or not is_enough(high):
            return None
        while low < high:
            middle = (low + high) // 2
            low, high = (low, middle) if is_enough(middle) else (middle + 1, high)
        return low

    def greatest(self, accepted: AcceptedWith, low: int, high: int) -> int | None:
        """Return the greatest number from ``low`` to ``high`` with which enough traces are accepted, or None.

        A smaller number accepts the same traces, or more.
        """
        mirrored = self.smallest(lambda bits, number: accepted(bits, -number), -high, -low)
        return None if mirrored is None else -mirrored

    def is_real(self, accepts: TraceMask, chance: Callable[[], float], tried: int) -> bool:
        """Whether a bound is no chance: ``tried`` bounds of its template were tried.

        Either the traces alone are unlikely to meet it (``chance``), or it is unlikely to separate them
        from recorded counterexamples so well.
        """
        bits, level = self.all, LEVEL / tried
        rejected = count(bits.counterexamples & ~accepts)
        if rejected and not self._made_up:
            good = count(accepts & bits.traces)
            if separated(good, count(bits.traces), rejected, count(bits.counterexamples)) <= level:
                return True
        return chance() <= level


def share(part: SampleMask, whole: SampleMask) -> float:
    """Return the share of the samples in ``whole`` that are in ``part``, in [0, 1]; 1 if there are none."""
    return (part & whole).bit_count() / whole.bit_count() if whole else 1.0


def gaps(starts: Sequence[tuple[int, int]], ends: Sequence[tuple[int, int]]) -> list[tuple[int, int]]:
    """Return, for each start with a later end in its trace, the number of the trace and the time to the next end.

    Both are positions in order: the number of a trace, and of a sample in it.
    """
    result = []
    index = 0
    for trace, sample in starts:
        while index < len(ends) and ends[index] <= (trace, sample):
            index += 1
        if index < len(ends) and ends[index][0] == trace:
            result.append((trace, ends[index][1] - sample))
    return result


def intervals(events: Sequence[tuple[int, int]]) -> list[int]:
    """Return the times before each event: since the event before it, or since the sample before its trace."""
    first = [sample + 1 for before, (trace, sample) in pairwise([(-1, 0), *events]) if before[0] != trace]
    return first + [after[1] - before[1] for before, after in pairwise(events) if before[0] == after[0]]
