"""Measure how busy other processes keep the machine."""

from __future__ import annotations

import os
import resource
import time
from pathlib import Path


class LoadMeter:
    """Measures the load since the creation of this object."""

    def __init__(self) -> None:
        self._start, self._busy, self._own = time.monotonic(), _busy_s(), _children_s()

    def other_cores(self) -> float | None:
        """Return the mean number of cores that were busy with processes other than ended children of this one.

        Return None if the system does not tell.
        """
        busy = _busy_s()
        if busy is None or self._busy is None:
            return None
        spent = busy - self._busy - (_children_s() - self._own)
        return max(0.0, spent / (time.monotonic() - self._start))


def _busy_s() -> float | None:
    """Return the seconds that all cores together have worked since the machine started."""
    try:
        ticks = Path("/proc/stat").read_text(encoding="ascii").split("\n", 1)[0].split()[1:]
    except OSError:
        return None
    user, nice, system, _idle, _waiting, *interrupts = map(int, ticks[:7])
    return (user + nice + system + sum(interrupts)) / os.sysconf("SC_CLK_TCK")


def _children_s() -> float:
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime
