"""A clock for tests of timeouts: it jumps ahead once a condition holds, however long that takes."""

from __future__ import annotations

import time
from collections.abc import Callable

from tests.waiting import HANG_S


class Clock:
    """Stands in for the module ``time``; jumps ahead by ``2 * HANG_S`` seconds once ``is_over()`` is true.

    Give the runtime a timeout of ``HANG_S``. It then waits for what is slow, and gives up what never comes.
    """

    def __init__(self, is_over: Callable[[], bool]) -> None:
        self._is_over = is_over
        self._jump = 0.0

    def monotonic(self) -> float:
        """Return the time in seconds, including the jump."""
        if not self._jump and self._is_over():
            self._jump = 2 * HANG_S
        return time.monotonic() + self._jump
