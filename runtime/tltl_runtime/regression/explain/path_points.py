"""The way of an episode, in few points: between two of them the player went almost straight, and almost evenly."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import Final

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.stealth.recordings.episode import Episode

Way = tuple[tuple[float, float, int, float], ...]
"""Points: x and y in metres, the automaton's state from there on, and when that was, in seconds from the beginning."""

EVERY: Final = 0.1
"""Seconds between two places along a way."""

_WITHIN: Final = 0.2
"""Metres that the player was away, at most, from where the way has it at that time: less than from a wall."""


def way_of(episode: Episode) -> Way:
    """The way of an episode, with a point wherever the state changes."""
    times = np.array([shot.time for shot in episode.snapshots])
    places = np.array([shot.player.position[:2] for shot in episode.snapshots])
    changes = (np.flatnonzero(np.diff(episode.states)) + 1).tolist()
    kept = {0, *changes, len(times) - 1}
    for first, last in pairwise(sorted(kept)):
        kept.update(_needed(times, places, first, last))
    return tuple(
        (round(float(x), 2), round(float(y), 2), int(episode.states[row]), round(float(times[row]), 2))
        for row in sorted(kept)
        for x, y in (places[row],)
    )


def places_along(way: Way) -> Iterator[tuple[float, float]]:
    """Where the player was each ``EVERY`` seconds, from the beginning, before the end."""
    times = np.array([time for *_, time in way])
    at = np.arange(times[0], times[-1], EVERY)
    xs, ys = (np.interp(at, times, [point[axis] for point in way]) for axis in (0, 1))
    yield from zip(xs.tolist(), ys.tolist(), strict=True)


def _needed(times: NDArray[np.float64], places: NDArray[np.float64], first: int, last: int) -> Iterator[int]:
    """The rows between two that it takes: where the player is farthest from the straight way, and so on.

    Distances are between places at one time, as in Meratnia and de By, Spatiotemporal compression techniques for moving
    point objects, EDBT 2004.
    """
    open_ = [(first, last)]
    while open_:
        first, last = open_.pop()
        if last - first < 2:
            continue
        share = (times[first : last + 1] - times[first]) / (times[last] - times[first])
        straight = places[first] + share[:, None] * (places[last] - places[first])
        away = np.hypot(*(places[first : last + 1] - straight).T)
        if away.max() > _WITHIN:
            middle = first + int(away.argmax())
            yield middle
            open_ += [(first, middle), (middle, last)]
