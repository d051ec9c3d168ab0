"""A clock for tests of timeouts: it jumps ahead when a condition holds."""

from __future__ import annotations

import time
from collections.abc import Callable

from tests.waiting import HANG_S


class Clock:
    """A stand-in for the module ``time``, which jumps ahead when ``is_over()`` is true.

    Give the runtime a timeout of ``HANG_S``. The clock jumps by twice as many seconds. So the
    runtime waits for something slow, but gives up something that never comes.
    """

    def __init__(self, is_over: Callable[[], bool]) -> None:
        self._is_over = is_over
        self._jump = 0.0

    def monotonic(self) -> float:
        """Return the time in seconds, including the jump."""
        if not self._jump and self._is_over():
            self._jump = 2 * HANG_S
        return time.monotonic() + self._jump
