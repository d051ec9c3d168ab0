"""What is found for all cells of a floor at once: neighbours, shortest ways, nearest cells, narrow places."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

GOALS: Final = 512
"""Those to which ways are found at once."""
ARRIVED: Final = 8
"""No move: the cell is the goal; a greater number is one that does not lead there."""

_MOVES: Final = ((1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (1, -1), (-1, 1), (-1, -1))
_NO_WAY: Final = 255


def neighbours(number: NDArray[np.int64]) -> NDArray[np.int64]:
    """For each move and cell the cell it leads to, int64 [8, cells]; the number of cells where it is none.

    ``number`` [rows, columns] is -1 where there is no cell, and numbers the others row by row.
    """
    rows, columns = np.nonzero(number >= 0)
    padded = np.pad(number, 1, constant_values=-1)
    found = []
    for dx, dy in _MOVES:
        target = padded[rows + 1 + dy, columns + 1 + dx]
        beside = (padded[rows + 1 + dy, columns + 1] >= 0) & (padded[rows + 1, columns + 1 + dx] >= 0)
        found.append(np.where(beside & (target >= 0), target, len(rows)))
    return np.array(found, dtype=np.int64)


def steps_to(neighbours: NDArray[np.int64], first: int) -> NDArray[np.uint8]:
    """The first move of a shortest way to goals ``first`` and following, uint8 [512 or fewer, cells].

    A breadth-first search from all goals at once, a bit for each; of moves that are as good, straight ones win.
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
    """Each cell's nearest numbered cell: numbers spread by a cell a round, straight before diagonal."""
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


def middles(mine: NDArray[np.bool_], most: int) -> NDArray[np.bool_]:
    """The middle cell of each run of at most ``most`` cells in a row of the grid."""
    found = np.zeros_like(mine)
    for row, line in enumerate(mine):
        edges = np.flatnonzero(np.diff(np.concatenate(([0], line.astype(np.int8), [0]))))
        for start, stop in zip(edges[::2], edges[1::2], strict=True):
            if stop - start <= most:
                found[row, (start + stop - 1) // 2] = True
    return found
