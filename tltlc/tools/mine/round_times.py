"""Round times: the bounds that people would write, such as `within 2.5 s` and `for 20 steps`."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Iterator
from typing import Final

from tltlc.core.record import record
from tltlc.resolve.values import number_text

_ROUND: Final = (10, 12, 15, 20, 25, 30, 40, 50, 60, 80)
"""Round numbers are these, times a power of ten."""
_POWERS: Final = range(-4, 7)
_FAR: Final = 1.5
"""Where the nearest round number of seconds is off by more than this factor, the time is in steps."""
_ROOM: Final = 10
"""A bound leaves a tenth of the time that was seen as room, in whole steps."""
_ROUNDING: Final = 1e-9


@record
class RoundTime:
    """A time in steps, and its text in a source file. ``is_seconds`` says whether the text is in seconds."""

    steps: int
    text: str
    is_seconds: bool = False


class RoundTimes:
    """Chooses round times. ``clock_s`` is the time between two samples in seconds; None without a clock."""

    def __init__(self, clock_s: float | None) -> None:
        self._in_steps = [
            RoundTime(steps, f"{steps} step{'s' * (steps > 1)}")
            for steps in (*range(1, _ROUND[0]), *(int(number) for number in _round_numbers() if number >= _ROUND[0]))
        ]
        self._in_seconds = [] if clock_s is None else list(_times_in_seconds(clock_s))

    def above(self, steps: int) -> RoundTime:
        """Return the least round time that leaves room above ``steps``, which is at least 1."""
        need = steps + steps // _ROOM
        candidates = [
            times[index]
            for times in (self._in_seconds, self._in_steps)
            if (index := bisect_left(times, need, key=_steps)) < len(times)
        ]
        return next((time for time in candidates if time.steps <= _FAR * need), candidates[-1])

    def below(self, steps: int) -> RoundTime:
        """Return the greatest round time that leaves room below ``steps``, which is at least 1."""
        most = steps - steps // _ROOM
        candidates = [
            times[index - 1]
            for times in (self._in_seconds, self._in_steps)
            if (index := bisect_right(times, most, key=_steps)) > 0
        ]
        return next((time for time in candidates if most <= _FAR * time.steps), candidates[-1])


def _steps(time: RoundTime) -> int:
    return time.steps


def _round_numbers() -> Iterator[float]:
    return (float(f"{digits}e{power}") for power in _POWERS for digits in _ROUND)


def _times_in_seconds(clock_s: float) -> Iterator[RoundTime]:
    """Yield the round numbers of seconds that are whole numbers of steps, in rising order."""
    for seconds in _round_numbers():
        steps = round(seconds / clock_s)
        if steps and abs(steps * clock_s - seconds) < _ROUNDING * seconds:
            yield RoundTime(steps, f"{number_text(seconds)} s", is_seconds=True)
