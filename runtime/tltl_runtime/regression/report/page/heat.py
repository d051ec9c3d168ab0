"""Heat maps: how much happened in which cell of a level."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from typing import Final

from tltl_runtime.regression.explain.account import Account
from tltl_runtime.regression.explain.path_points import EVERY, places_along
from tltl_runtime.stealth.level import Box
from tltlc.core.record import record

TIME_CELL: Final = 0.5
"""Metres to a side of the cells in which time is counted."""

ENDS_CELL: Final = 1.0
"""Metres to a side of the cells in which ends are counted."""


@record
class Heat:
    """Cells of ``cell`` metres, ``columns`` in a row, counted from the north-west: pairs of index and value, sorted."""

    cell: float
    columns: int
    values: tuple[tuple[int, float], ...]


def time_spent(bounds: Box, accounts: Sequence[Account]) -> Heat:
    """The seconds that an episode spends in each cell, on average."""
    places = [place for each in accounts for place in places_along(each.way)]
    return _heat(bounds, TIME_CELL, places, EVERY / max(1, len(accounts)))


def failed_ends(bounds: Box, accounts: Sequence[Account]) -> Heat:
    """How many of the episodes that failed ended in each cell."""
    return _heat(bounds, ENDS_CELL, [each.place[:2] for each in accounts if not each.success], 1.0)


def _heat(bounds: Box, cell: float, places: Iterable[tuple[float, float]], weight: float) -> Heat:
    (west, south, _), (east, north, _) = bounds.low, bounds.high
    columns, rows = (max(1, -int(-side // cell)) for side in (east - west, north - south))
    counts: Counter[int] = Counter()
    for x, y in places:
        column = min(max(0, int((x - west) / cell)), columns - 1)
        row = min(max(0, int((north - y) / cell)), rows - 1)
        counts[row * columns + column] += 1
    values = ((index, round(count * weight, 4)) for index, count in sorted(counts.items()))
    return Heat(cell, columns, tuple(each for each in values if each[1]))
