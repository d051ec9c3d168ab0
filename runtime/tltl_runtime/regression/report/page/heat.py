"""Heat maps: time spent and failures by cells of a level."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from typing import Final

from tltl_runtime.game.geometry import Box
from tltl_runtime.regression.explain.account import Account
from tltl_runtime.regression.explain.path_points import EVERY, places_along
from tltlc.api import record

TIME_CELL: Final = 0.5
"""The side of a cell, in metres, for time spent."""

ENDS_CELL: Final = 1.0
"""The side of a cell, in metres, for ends of episodes."""


@record
class Heat:
    """A grid of cells of ``cell`` metres, with ``columns`` cells in a row.

    ``values`` are pairs of index and value, sorted.  Indices count row by row from the north-west.
    """

    cell: float
    columns: int
    values: tuple[tuple[int, float], ...]


def time_spent(bounds: Box, accounts: Sequence[Account]) -> Heat:
    """The mean number of seconds that an episode spends in each cell."""
    places = [place for account in accounts for place in places_along(account.way)]
    return _heat(bounds, TIME_CELL, places, EVERY / max(1, len(accounts)))


def failed_ends(bounds: Box, accounts: Sequence[Account]) -> Heat:
    """The number of failed episodes that ended in each cell."""
    return _heat(bounds, ENDS_CELL, [account.place[:2] for account in accounts if not account.summary.success], 1.0)


def _heat(bounds: Box, cell: float, places: Iterable[tuple[float, float]], weight: float) -> Heat:
    (west, south, _), (east, north, _) = bounds.low, bounds.high
    columns, rows = (max(1, -int(-side // cell)) for side in (east - west, north - south))
    counts: Counter[int] = Counter()
    for x, y in places:
        column = min(max(0, int((x - west) / cell)), columns - 1)
        row = min(max(0, int((north - y) / cell)), rows - 1)
        counts[row * columns + column] += 1
    values = ((index, round(count * weight, 4)) for index, count in sorted(counts.items()))
    return Heat(cell, columns, tuple(pair for pair in values if pair[1]))
