"""The simplified trajectory of an episode: few points, with nearly straight motion between them."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import Final

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.game.episode import RecordedEpisode

TrajectoryPoints = tuple[tuple[float, float, int, float], ...]
"""Points (x, y, state, time), with x and y in metres, and the time in seconds since the start.

``state`` is the automaton's state from this point to the next.
"""

POSITION_INTERVAL_S: Final = 0.1
"""Seconds between two positions that :func:`positions_along` yields."""

_TOLERANCE_M: Final = 0.2
"""The greatest error of the simplified trajectory, in metres.

It is less than the distance of a player's centre from a wall, so that no trajectory crosses a wall.
"""


def simplified_trajectory(episode: RecordedEpisode) -> TrajectoryPoints:
    """Return few points that approximate an episode's trajectory to within 0.2 m.

    One of them is at each change of the automaton's state. The result is empty if the game does not
    say where the player is.
    """
    if episode.positions is None:
        return ()
    times, places = episode.times, episode.positions[:, :2]
    changes = (np.flatnonzero(np.diff(episode.states)) + 1).tolist()
    rows = {0, *changes, len(times) - 1}
    for first, last in pairwise(sorted(rows)):
        rows.update(_split_rows(times, places, first, last))
    return tuple(
        (round(float(x), 2), round(float(y), 2), int(episode.states[row]), round(float(times[row]), 2))
        for row in sorted(rows)
        for x, y in (places[row],)
    )


def positions_along(trajectory: TrajectoryPoints) -> Iterator[tuple[float, float]]:
    """Yield the positions (x, y), in metres, on a trajectory, one every ``POSITION_INTERVAL_S`` seconds.

    The first is at the start of the trajectory, and the last is before its end. The trajectory must
    not be empty.
    """
    times = np.array([time for *_, time in trajectory])
    moments = np.arange(times[0], times[-1], POSITION_INTERVAL_S)
    xs, ys = (np.interp(moments, times, [point[axis] for point in trajectory]) for axis in (0, 1))
    yield from zip(xs.tolist(), ys.tolist(), strict=True)


def _split_rows(times: NDArray[np.float64], places: NDArray[np.float64], first: int, last: int) -> Iterator[int]:
    """Yield the rows between ``first`` and ``last`` that the simplified trajectory needs.

    A row is an index into ``times`` and ``places``. Split at the row that is farthest from the
    straight line between the rows ``first`` and ``last``, if it is farther than ``_TOLERANCE_M``.
    Repeat for both halves. The distance of a row is measured to the point of the line at the same
    time, as in Meratnia and de By, Spatiotemporal compression techniques for moving point objects,
    EDBT 2004.
    """
    spans = [(first, last)]
    while spans:
        first, last = spans.pop()
        if last - first < 2:
            continue
        share = (times[first : last + 1] - times[first]) / (times[last] - times[first])
        straight = places[first] + share[:, None] * (places[last] - places[first])
        distances = np.hypot(*(places[first : last + 1] - straight).T)
        if distances.max() > _TOLERANCE_M:
            middle = first + int(distances.argmax())
            yield middle
            spans += [(first, middle), (middle, last)]
