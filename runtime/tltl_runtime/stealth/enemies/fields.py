"""Neighbours, shortest paths, nearest cells and narrow places for all cells of a floor."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

GOALS: Final = 512
"""The number of goals for which paths are searched at once."""
ARRIVED: Final = 8
"""The code in place of a move where the cell is the goal.

A greater code means that the goal cannot be reached.
"""

_MOVES: Final = ((1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (1, -1), (-1, 1), (-1, -1))
_NO_WAY: Final = 255


def neighbours(number: NDArray[np.int64]) -> NDArray[np.int64]:
    """For each move and cell, the cell that the move leads to, int64 [8, cells].

    The value is the number of cells if the move is impossible. ``number`` [rows, columns] is -1
    where there is no cell; the other cells are numbered row by row.
    """
    rows, columns = np.nonzero(number >= 0)
    padded = np.pad(number, 1, constant_values=-1)
    targets = []
    for dx, dy in _MOVES:
        target = padded[rows + 1 + dy, columns + 1 + dx]
        beside = (padded[rows + 1 + dy, columns + 1] >= 0) & (padded[rows + 1, columns + 1 + dx] >= 0)
        targets.append(np.where(beside & (target >= 0), target, len(rows)))
    return np.array(targets, dtype=np.int64)


def steps_to(neighbours: NDArray[np.int64], first: int) -> NDArray[np.uint8]:
    """The first move of a shortest path from each cell to up to 512 goals from ``first`` on.

    The result is uint8 [512 or fewer, cells]. One breadth-first search runs from all goals at once,
    with one bit per goal; among equally short paths, straight moves are preferred.
    """
    cells = neighbours.shape[1]
    goals = np.arange(first, min(first + GOALS, cells))
    frontier = np.zeros((cells + 1, GOALS // 64), dtype="<u8")
    frontier[goals, (goals - first) // 64] = np.uint64(1) << ((goals - first) % 64).astype(np.uint64)
    unseen = ~frontier[:cells]
    bits = np.zeros((3, cells, GOALS // 64), dtype="<u8")
    while frontier.any():
        reached = np.zeros_like(frontier)
        for move in range(len(_MOVES)):
            new = frontier[neighbours[move]]
            new &= unseen
            unseen ^= new
            reached[:cells] |= new
            for bit in range(3):
                if move >> bit & 1:
                    bits[bit] |= new
        frontier = reached
    packed = _unpacked(bits[0]) | _unpacked(bits[1]) << 1 | _unpacked(bits[2]) << 2
    packed[_unpacked(unseen) > 0] = _NO_WAY
    moves: NDArray[np.uint8] = np.ascontiguousarray(packed.T[: len(goals)])
    moves[goals - first, goals] = ARRIVED
    return moves


def _unpacked(words: NDArray[np.uint64]) -> NDArray[np.uint8]:
    return np.unpackbits(words.view(np.uint8), axis=1, bitorder="little")


def nearest_numbers(number: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return each cell's nearest numbered cell.

    Numbers spread by one cell per round, straight before diagonal.
    """
    number = number.copy()
    while (number < 0).any():
        padded = np.pad(number, 1, constant_values=-1)
        spread = number.copy()
        height, width = number.shape
        for dx, dy in _MOVES:
            beside = padded[1 + dy : 1 + dy + height, 1 + dx : 1 + dx + width]
            spread = np.where((spread < 0) & (beside >= 0), beside, spread)
        number = spread
    return number


def middles(cells: NDArray[np.bool_], most: int) -> NDArray[np.bool_]:
    """The middle cell of each run of at most ``most`` cells in a row of the grid."""
    middle = np.zeros_like(cells)
    for row, line in enumerate(cells):
        edges = np.flatnonzero(np.diff(np.concatenate(([0], line.astype(np.int8), [0]))))
        for start, stop in zip(edges[::2], edges[1::2], strict=True):
            if stop - start <= most:
                middle[row, (start + stop - 1) // 2] = True
    return middle
