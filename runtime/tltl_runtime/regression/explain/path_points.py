"""The simplified trajectory of an episode: few points, between which the player moved almost linearly."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import Final

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.game.episode import RecordedEpisode

Way = tuple[tuple[float, float, int, float], ...]
"""Points (x, y, state, time): metres, the automaton's state from there on, and seconds since the start."""

EVERY: Final = 0.1
"""Seconds between two places along a trajectory."""

_WITHIN: Final = 0.2
"""The greatest error of the simplified trajectory, in metres.

It is less than the distance that a player keeps from a wall.
"""


def way_of(episode: RecordedEpisode) -> Way:
    """Simplify the trajectory of an episode.  Each change of the state gets a point."""
    times, places = episode.times, episode.positions[:, :2]
    changes = (np.flatnonzero(np.diff(episode.states)) + 1).tolist()
    rows = {0, *changes, len(times) - 1}
    for first, last in pairwise(sorted(rows)):
        rows.update(_needed(times, places, first, last))
    return tuple(
        (round(float(x), 2), round(float(y), 2), int(episode.states[row]), round(float(times[row]), 2))
        for row in sorted(rows)
        for x, y in (places[row],)
    )


def places_along(way: Way) -> Iterator[tuple[float, float]]:
    """Yield the player's position every ``EVERY`` seconds, from the start until just before the end."""
    times = np.array([time for *_, time in way])
    at = np.arange(times[0], times[-1], EVERY)
    xs, ys = (np.interp(at, times, [point[axis] for point in way]) for axis in (0, 1))
    yield from zip(xs.tolist(), ys.tolist(), strict=True)


def _needed(times: NDArray[np.float64], places: NDArray[np.float64], first: int, last: int) -> Iterator[int]:
    """Yield the rows between ``first`` and ``last`` that the simplified trajectory needs.

    Split at the row with the greatest distance from the straight line, and repeat for both halves.
    Distances are between positions at the same time, as in Meratnia and de By, Spatiotemporal
    compression techniques for moving point objects, EDBT 2004.
    """
    open_ = [(first, last)]
    while open_:
        first, last = open_.pop()
        if last - first < 2:
            continue
        share = (times[first : last + 1] - times[first]) / (times[last] - times[first])
        straight = places[first] + share[:, None] * (places[last] - places[first])
        distances = np.hypot(*(places[first : last + 1] - straight).T)
        if distances.max() > _WITHIN:
            middle = first + int(distances.argmax())
            yield middle
            open_ += [(first, middle), (middle, last)]
