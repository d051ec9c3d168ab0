"""What else a machine did while something was measured on it."""

from __future__ import annotations

import os
import resource
import time
from pathlib import Path


class Load:
    """Begins to watch when it is made."""

    def __init__(self) -> None:
        self._began, self._busy, self._own = time.monotonic(), _busy_s(), _children_s()

    def other_cores(self) -> float | None:
        """How many cores were busy since then, on average, with what is no ended child of this process.

        None where the system does not tell.
        """
        busy = _busy_s()
        if busy is None or self._busy is None:
            return None
        spent = busy - self._busy - (_children_s() - self._own)
        return max(0.0, spent / (time.monotonic() - self._began))


def _busy_s() -> float | None:
    """Seconds that all cores of the machine have worked so far."""
    try:
        ticks = Path("/proc/stat").read_text(encoding="ascii").split("\n", 1)[0].split()[1:]
    except OSError:
        return None
    user, nice, system, _idle, _waiting, *interrupts = map(int, ticks[:7])
    return (user + nice + system + sum(interrupts)) / os.sysconf("SC_CLK_TCK")


def _children_s() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime
