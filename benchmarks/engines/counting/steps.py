"""Time steps of monitors that count: ``steps ROUNDS MONITORS`` prints nanoseconds of CPU time per step, as JSON lines.

``first`` is the time of the first steps of a count, and ``last`` that of the last ones.
"""

import json
import sys
import time
from typing import Any

from quiet_monitor import Monitor  # type: ignore[import-not-found]

STEPS, BEFORE = 20, 570
QUIET, LOUD = {"pit": False}, {"pit": True}


def nanoseconds(monitors: list[Any], before: int) -> float:
    """Return the time of a step after ``before`` steps of the count."""
    for monitor in monitors:
        monitor.reset()
        monitor.step(LOUD)
        for _ in range(before):
            monitor.step(QUIET)
    start = time.process_time_ns()
    for monitor in monitors:
        for _ in range(STEPS):
            monitor.step(QUIET)
    return (time.process_time_ns() - start) / (len(monitors) * STEPS)


if __name__ == "__main__":
    rounds, count = map(int, sys.argv[1:])
    all_monitors = [Monitor() for _ in range(count)]
    for _ in range(rounds):
        first = nanoseconds(all_monitors, 0)
        print(json.dumps({"first": first, "last": nanoseconds(all_monitors, BEFORE)}), flush=True)
