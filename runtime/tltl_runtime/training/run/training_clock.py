"""The clock of a training, by which its limit of minutes counts."""

from __future__ import annotations

import time


class TrainingClock:
    """Measures the time of a training: from the start of its command, over all resumptions.

    ``began`` is when the command began, a time of ``time.perf_counter``. ``before`` are the seconds
    that the training had taken before, up to its checkpoint.
    """

    def __init__(self, began: float, before: float = 0.0) -> None:
        self._began, self._before = began, before

    def add(self, seconds: float) -> None:
        """Add the seconds of an earlier run that are in no checkpoint, such as those of a search that was stopped."""
        self._before += seconds

    @property
    def seconds(self) -> float:
        """The seconds of the training so far."""
        return self._before + time.perf_counter() - self._began
