"""A clock that lets the runtime's patience end when everything has come that will come, however long that takes."""

from __future__ import annotations

import time
from collections.abc import Callable

from tests.waiting import HANG_S


class Clock:
    """Stands in for the module ``time``; it jumps by more than ``HANG_S`` seconds once ``is_over()`` is true.

    Give the runtime a patience of ``HANG_S``: then what is slow is waited for, and what never comes is given up.
    """

    def __init__(self, is_over: Callable[[], bool]) -> None:
        self._is_over = is_over
        self._jump = 0.0

    def monotonic(self) -> float:
        """Seconds."""
        if not self._jump and self._is_over():
            self._jump = 2 * HANG_S
        return time.monotonic() + self._jump
