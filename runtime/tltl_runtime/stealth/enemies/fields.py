"""Functions that compute arrays over the cells of a floor that enemies walk on.

The arrays say which cells are neighbours, how shortest paths begin, which cells are nearest, and
where the floor is narrow.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

GOALS: Final = 512
"""The number of goals to which :func:`steps_to` searches paths at once."""
ARRIVED: Final = 8
"""The number that :func:`steps_to` returns where the cell is the goal itself.

A smaller number, 0 to 7, is a move. A greater number means that no path leads to the goal.
"""

_MOVES: Final = ((1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (1, -1), (-1, 1), (-1, -1))
_NO_PATH: Final = 255


def neighbours(number: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the cell to which each of the 8 moves leads from each cell, int64 [8, cells].

    ``number`` [rows, columns] numbers the cells row by row; it is -1 where there is no cell. The
    result is the number of a cell, or, for a move that is impossible, ``cells`` (one more than the
    greatest number).
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
    """Return the first move of a shortest path from each cell to each of up to 512 goals.

    ``neighbours`` is the result of :func:`neighbours`. The goals are the cells from number
    ``first`` on. The result is uint8 [512 or fewer, cells]; :data:`ARRIVED` explains the numbers.
    One breadth-first search runs from all goals at once, with one bit per goal. Among equally short
    paths, the search prefers straight moves to diagonal ones.
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
    packed = _unpack_bits(bits[0]) | _unpack_bits(bits[1]) << 1 | _unpack_bits(bits[2]) << 2
    packed[_unpack_bits(unseen) > 0] = _NO_PATH
    moves: NDArray[np.uint8] = np.ascontiguousarray(packed.T[: len(goals)])
    moves[goals - first, goals] = ARRIVED
    return moves


def _unpack_bits(words: NDArray[np.uint64]) -> NDArray[np.uint8]:
    return np.unpackbits(words.view(np.uint8), axis=1, bitorder="little")


def nearest_numbers(number: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return for each cell the number of the nearest numbered cell, int64 [rows, columns].

    In ``number`` [rows, columns], -1 marks cells without a number. At least one cell must have a
    number. Numbers spread by one cell per round, straight before diagonal, so the result is
    approximate.
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
    """Return a mask of the middle cell of each narrow run of cells, such as a passage.

    A run is a sequence of true cells in a row of ``cells``. It is narrow if it has at most ``most``
    cells.
    """
    middle = np.zeros_like(cells)
    for row, line in enumerate(cells):
        edges = np.flatnonzero(np.diff(np.concatenate(([0], line.astype(np.int8), [0]))))
        for start, stop in zip(edges[::2], edges[1::2], strict=True):
            if stop - start <= most:
                middle[row, (start + stop - 1) // 2] = True
    return middle
