"""A clock for deadlines: a test sees that time is up, and nobody waits."""

from __future__ import annotations

import time


class FastClock:
    """Stands in for the module ``time`` in a module of tltlc.

    Its clock goes on only when it is read: each time by ``step_s`` seconds.
    """

    sleep = staticmethod(time.sleep)

    def __init__(self, step_s: float) -> None:
        self._step_s, self._now_s = step_s, 0.0

    def monotonic(self) -> float:
        """Return the time in seconds."""
        self._now_s += self._step_s
        return self._now_s
