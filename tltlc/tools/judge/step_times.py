"""Keep the times of the steps of a trace."""

from __future__ import annotations

from array import array
from collections.abc import Iterable, Iterator

from tltlc.automaton.fspa import Fspa
from tltlc.monitor.samples import STEP_LENGTH
from tltlc.monitor.traces import TraceSample


class StepTimes:
    """Keeps the times of the samples of a trace, in seconds; the first sample has the time 0."""

    def __init__(self, fspa: Fspa) -> None:
        self._clock_s, self._varies = fspa.clock_s, fspa.clock_varies
        self._times = array("d")

    def watched(self, samples: Iterable[TraceSample]) -> Iterator[TraceSample]:
        """Yield the samples unchanged, and keep their times if the clock varies."""
        for sample in samples:
            if self._varies:
                self._times.append(self._times[-1] + sample[STEP_LENGTH] if self._times else 0.0)
            yield sample

    def seconds(self, step: int) -> float | None:
        """Return the time of a step that was read; ``step`` counts from 1. None if the spec has no clock."""
        if self._varies:
            return self._times[step - 1]
        return None if self._clock_s is None else (step - 1) * self._clock_s


def seconds_text(seconds: float | None) -> str:
    """Return a time as a message shows it behind a step, `` (1.03 s)``: to 0.01 s; empty for None."""
    if seconds is None:
        return ""
    digits = f"{seconds:.2f}"
    return f" ({digits.removesuffix('0')} s)"
