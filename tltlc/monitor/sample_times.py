"""Check the times of the samples of a trace against the clock of the spec, and find the lengths of its steps."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import inf, isfinite
from typing import Final

from tltlc.monitor.samples import number_text
from tltlc.resolve.spec import Signal

_TIME: Final = "time"
_LENGTH: Final = "dt"

_JITTER: Final = 0.5
"""A sample may be early or late by this share of the clock's period."""

_CLOCK_ERROR: Final = 0.02
"""The clock of the game may be fast or slow by this share."""

_ROUNDING_S: Final = 1e-3
"""Times may be rounded to milliseconds."""


def times_name(names: Iterable[str], signals: Iterable[Signal]) -> str | None:
    """Return the name of the column with the times of the samples in seconds; None if there is none.

    ``names`` are the names of all columns of a CSV file, or all keys of a JSON object. The column
    is called ``time``, in upper or lower case. A column with the name of a signal does not count.
    """
    return _named(_TIME, names, signals)


def lengths_name(names: Iterable[str], signals: Iterable[Signal]) -> str | None:
    """Return the name of the column with the time of each sample since the one before; None if there is none.

    The arguments are those of :func:`times_name`. The column is called ``dt``, in upper or lower case.
    """
    return _named(_LENGTH, names, signals)


def _named(wanted: str, names: Iterable[str], signals: Iterable[Signal]) -> str | None:
    taken = {signal.name for signal in signals}
    candidates = [name for name in names if name.lower() == wanted and name not in taken]
    return wanted if wanted in candidates else candidates[0] if candidates else None


class SampleTimes:
    """Checks the times of the samples of one trace, in order.

    Each time must be later than the time before, or if the clock ``varies``, not earlier; then
    ``length_s`` is the time since the sample before, 0 at the first sample. If the spec declares a
    clock with a period of c seconds, there are two more conditions. The time between two samples must
    be at most 1.5 * c, so that no sample is missing. The time from the first sample to sample i (i from
    0) must differ from i * c by at most c / 2, plus 2 % of i * c because the clock of the game may be
    fast or slow. Both conditions allow 1 ms more for rounding.

    ``clock_s`` is the period of the clock in seconds, None without a clock.
    """

    def __init__(self, clock_s: float | None, varies: bool = False) -> None:
        self._clock_s, self.varies = clock_s, varies
        self._count = 0
        self._first = self._last = 0.0
        self.length_s = 0.0
        self._counts_lengths = False

    def problem(self, time: float) -> str | None:
        """Take the time of the next sample, in seconds; return what is wrong with this time, or None."""
        count, last = self._count, self._last
        self._count, self._last = count + 1, time
        if not isfinite(time):
            return f"the time is {time}, not a finite number"
        if count == 0:
            self._first = time
            return None
        self.length_s = time - last
        if time < last or (time == last and not self.varies):
            return f"the time is {number_text(time)} s, and the sample before is at {number_text(last)} s"
        return None if self._clock_s is None else self._clock_problem(count, last, time, self._clock_s)

    def _clock_problem(self, count: int, last: float, time: float, clock_s: float) -> str | None:
        passed, due, period = time - last, count * clock_s, _seconds(clock_s)
        if passed > (1.0 + _JITTER) * clock_s + _ROUNDING_S:
            return f"this is {_seconds(passed)} s after the sample before, and the clock has one every {period} s"
        if abs(time - self._first - due) > _JITTER * clock_s + _CLOCK_ERROR * due + _ROUNDING_S:
            mean = _seconds((time - self._first) / count)
            return f"until here there is a sample every {mean} s, and the clock has one every {period} s"
        return None

    def length_problem(self, length_s: float) -> str | None:
        """Take the length of the next step, in seconds; return what is wrong with it, or None."""
        self._counts_lengths = True
        self.length_s = length_s
        if 0.0 <= length_s < inf:
            return None
        return f"the length of the step is {number_text(length_s)} s, not a number of at least 0"

    @property
    def advice(self) -> str:
        """The advice in the error about a wrong time: how to record the trace so that its times are right."""
        if self._counts_lengths:
            return "record the seconds since the sample before; 0 at the first sample"
        if self._clock_s is None:
            return "record the samples in the order in which they happen, with times in seconds"
        return "record every sample at the rate of `clock`, with times in seconds, or change `clock` in the spec"


def _seconds(seconds: float) -> str:
    return number_text(float(f"{seconds:.4g}"))


def times_fit(times: Sequence[float], clock_s: float | None, varies: bool = False) -> bool:
    """Whether :class:`SampleTimes` finds no wrong time among the times of a trace."""
    check = SampleTimes(clock_s, varies)
    return all(check.problem(time) is None for time in times)
