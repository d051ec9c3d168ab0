"""Cells: the places of a search, for any game.

Two moments of a game are in the same cell if the player is in the same square of a grid. In a game
that does not say where the player is, they are in the same cell if the signals of the spec have
nearly the same values; if these are bools alone, which say little, the game's other signals count,
too. The search keeps the cells of each state of the automaton apart.
"""

from __future__ import annotations

import hashlib
import struct
from collections.abc import Iterable, Mapping, Sequence
from math import floor, isfinite, nan
from typing import Any, Final

import numpy as np

from tltl_runtime.game.geometry import Box, Point
from tltlc.api import Signal, record

NO_CELL: Final = -1
"""The cell of a moment in which the game does not say where the player is."""

_SQUARES: Final = 32
"""The squares along the longer side of a level with an outline."""
_SQUARES_OF_SEEN: Final = 16
"""The squares along the longest side of the part of a level that a short random play has seen."""
_MOST_CELLS: Final = 4096
"""The bins of all numeric signals together give about this many cells."""
_BINS: Final = 4, 64
"""The least and the most bins of a numeric signal."""


@record
class SignalBins:
    """The bins of a numeric signal: the first begins at ``low``, and each is ``width`` wide.

    A value outside the range of the bins is in another bin of the same width.
    """

    name: str
    low: float
    width: float


@record
class CellGrid:
    """What makes a cell: the position of the player, or the values of signals.

    ``side`` is the side of the squares (cubes, where a position has a z) in which the player stands,
    in the unit of the game's positions. It is None if the game gives no positions; then ``bins`` has
    the numeric signals, and ``bools`` the names of the others.
    """

    side: float | None
    bins: tuple[SignalBins, ...] = ()
    bools: tuple[str, ...] = ()


def cell_of(grid: CellGrid, position: Point | None, sample: Mapping[str, Any]) -> int:
    """Return the number of the cell of a moment, at least 0 and below 2^63, or ``NO_CELL``.

    ``position`` is that of the player, and ``sample`` has the values of the signals. Equal cells have
    equal numbers in all processes.
    """
    if grid.side is None:
        indices = [_index(sample.get(part.name), part.low, part.width) for part in grid.bins]
        indices += [int(bool(sample.get(name))) for name in grid.bools]
    elif position is None:
        return NO_CELL
    else:
        indices = [_index(number, 0.0, grid.side) for number in position]
    digest = hashlib.blake2b(struct.pack(f"<{len(indices)}q", *indices), digest_size=8).digest()
    return int.from_bytes(digest, "little") >> 1


def position_grid(bounds: Box | None, seen: Sequence[Point]) -> CellGrid:
    """Return the grid of a game that says where the player is.

    ``bounds`` are those of the level's outline, None if there is none. ``seen`` are positions of the
    player in a short play; they count only without ``bounds``.
    """
    if bounds is not None:
        sides = [high - low for low, high in zip(bounds.low[:2], bounds.high[:2], strict=True)]
        return CellGrid(max(sides) / _SQUARES)
    longest = float(np.ptp(np.array(seen), axis=0).max()) if seen else 0.0
    return CellGrid(longest / _SQUARES_OF_SEEN if longest > 0 else 1.0)


def signal_grid(signals: Iterable[Signal], samples: Sequence[Mapping[str, Any]]) -> CellGrid:
    """Return the grid of a game that does not say where the player is.

    ``signals`` are those of the spec. A numeric signal has bins over the range that the spec declares;
    where that is open, over the values in ``samples``, which come from a short play. If all signals
    of the spec are bools, the other signals in ``samples`` are used, too.
    """
    known = list(signals)
    if all(signal.type == "bool" for signal in known):
        known += _others(known, samples)
    numeric = [signal for signal in known if signal.type != "bool"]
    least, most = _BINS
    count = min(most, max(least, round(_MOST_CELLS ** (1 / len(numeric))))) if numeric else least
    bins = [_bins(signal, [_number(sample.get(signal.name)) for sample in samples], count) for signal in numeric]
    return CellGrid(None, tuple(bins), tuple(signal.name for signal in known if signal.type == "bool"))


def _others(known: Sequence[Signal], samples: Sequence[Mapping[str, Any]]) -> list[Signal]:
    """Return the signals of a game that its spec does not use and whose values are numbers or bools."""
    names = {signal.name for signal in known}
    others = [(name, value) for name, value in (samples[0] if samples else {}).items() if name not in names]
    return [
        Signal(name, "bool" if isinstance(value, (bool, np.bool_)) else "number", None, None)
        for name, value in others
        if isinstance(value, (bool, np.bool_)) or _number(value) == _number(value)
    ]


def _number(value: Any) -> float:
    """Return a number, and NaN for anything else: only the signals of the spec are known to be numbers."""
    try:
        return float(value)
    except (TypeError, ValueError):
        return nan


def _bins(signal: Signal, seen: Sequence[float], count: int) -> SignalBins:
    finite = [value for value in seen if isfinite(value)] or [0.0]
    low = min(finite) if signal.low is None else signal.low
    high = max(finite) if signal.high is None else signal.high
    width = (high - low) / count
    return SignalBins(signal.name, low, width if isfinite(width) and width > 0 else 1.0)


def _index(value: Any, low: float, width: float) -> int:
    """Return the number of the bin of a value; those of infinite values are at the ends."""
    share = (_number(value) - low) / width
    return floor(min(max(share, -(2.0**62)), 2.0**62)) if share == share else 0
