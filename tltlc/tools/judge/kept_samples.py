"""Keep the samples of a trace."""

from __future__ import annotations

from array import array
from collections.abc import Iterable, Iterator

from tltlc.monitor.samples import STEP_LENGTH
from tltlc.monitor.traces import TraceSample
from tltlc.resolve.spec import Signal


class KeptSamples:
    """Keeps the samples of a trace in 8 bytes for each signal."""

    def __init__(self, signals: Iterable[Signal], *, clock_varies: bool) -> None:
        self._names = (*(signal.name for signal in signals), *((STEP_LENGTH,) if clock_varies else ()))
        self._columns = tuple(array("d") for _ in self._names)
        self._count = 0

    def watched(self, samples: Iterable[TraceSample]) -> Iterator[TraceSample]:
        """Yield the samples unchanged, and keep them."""
        for sample in samples:
            yield sample
            # The monitor has taken the sample: it is not faulty.
            self._count += 1
            for name, column in zip(self._names, self._columns, strict=True):
                column.append(sample[name])

    def all(self) -> list[TraceSample]:
        """Return the samples that the monitor has taken, in order."""
        if not self._names:
            return [{} for _ in range(self._count)]
        return [dict(zip(self._names, values, strict=True)) for values in zip(*self._columns, strict=True)]
