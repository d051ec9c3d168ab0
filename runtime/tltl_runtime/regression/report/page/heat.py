"""Heat maps: where episodes spend time and where they fail, by cells of a level."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from typing import Final

from tltl_runtime.game.geometry import Box
from tltl_runtime.regression.explain.explained_episode import ExplainedEpisode
from tltl_runtime.regression.explain.path_points import POSITION_INTERVAL_S, positions_along
from tltlc.api import record

TIME_CELL: Final = 0.5
"""The side, in metres of the map, of the cells in which the time spent is measured."""

ENDS_CELL: Final = 1.0
"""The side, in metres of the map, of the cells in which the ends of failed episodes are counted."""


@record
class Heat:
    """A grid of square cells with values. ``cell`` is the side of a cell, in metres of the level.

    A row has ``columns`` cells. ``values`` are pairs of the index of a cell and its value, sorted by
    index. Cells with value 0 are left out. Indices count row by row from the north-west corner.
    """

    cell: float
    columns: int
    values: tuple[tuple[int, float], ...]


def time_spent(bounds: Box, episodes: Sequence[ExplainedEpisode], metre: float = 1.0) -> Heat:
    """Return the mean number of seconds that an episode spends in each cell of a level.

    ``bounds`` are those of the level. ``metre`` is the length in the level, in metres, of a metre on
    the map.
    """
    positions = [position for episode in episodes for position in positions_along(episode.way)]
    return _grid(bounds, TIME_CELL * metre, positions, POSITION_INTERVAL_S / max(1, len(episodes)))


def failed_ends(bounds: Box, episodes: Sequence[ExplainedEpisode], metre: float = 1.0) -> Heat:
    """Return the number of failed episodes that ended in each cell of a level.

    ``bounds`` and ``metre`` are as in :func:`time_spent`.
    """
    return _grid(
        bounds,
        ENDS_CELL * metre,
        [episode.place[:2] for episode in episodes if not episode.summary.success and episode.place is not None],
        1.0,
    )


def _grid(bounds: Box, cell: float, positions: Iterable[tuple[float, float]], weight: float) -> Heat:
    """Return a grid over ``bounds``: a cell's value is ``weight`` times the number of ``positions`` in it.

    ``cell`` is the side of the cells, in metres. A position outside the bounds counts in the nearest
    cell.
    """
    (west, south, _), (east, north, _) = bounds.low, bounds.high
    columns, rows = (max(1, -int(-side // cell)) for side in (east - west, north - south))
    counts: Counter[int] = Counter()
    for x, y in positions:
        column = min(max(0, int((x - west) / cell)), columns - 1)
        row = min(max(0, int((north - y) / cell)), rows - 1)
        counts[row * columns + column] += 1
    values = ((index, round(count * weight, 4)) for index, count in sorted(counts.items()))
    return Heat(cell, columns, tuple(pair for pair in values if pair[1]))
