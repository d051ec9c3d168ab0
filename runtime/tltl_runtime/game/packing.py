"""Compact encodings of values over time; ``packing.js`` decodes them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import groupby
from typing import Final, TypeVar

from tltl_runtime.game.geometry import Box

T = TypeVar("T")

_DIGITS: Final = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/"
_CONTINUATION: Final = 32
"""This is added to each digit of a number except the last, to mark that more digits follow."""


def steps(values: Iterable[float], scale: float) -> str:
    """Encode numbers as a short text: the first number, then the difference of each from the one before.

    Each number is first multiplied by ``scale`` and rounded to an integer. Integers are encoded as
    in source maps (base64 VLQ), so that a small difference takes a single character.
    """
    integers = [round(value * scale) for value in values]
    return "".join(_vlq(after - before) for before, after in zip([0, *integers], integers, strict=False))


def _vlq(number: int) -> str:
    """Encode an integer as in source maps (base64 VLQ)."""
    remaining, digits = abs(number) << 1 | (number < 0), ""
    while remaining >= _CONTINUATION:
        digits += _DIGITS[remaining % _CONTINUATION + _CONTINUATION]
        remaining //= _CONTINUATION
    return digits + _DIGITS[remaining]


def runs(values: Iterable[T]) -> list[list[T | int]]:
    """Run-length encode values as pairs of a value and a count: ``[5, 5, 7] -> [[5, 2], [7, 1]]``."""
    return [[value, sum(1 for _ in same)] for value, same in groupby(values)]


def scaled_runs(values: Iterable[float], scale: float) -> list[list[int]]:
    """Encode numbers with :func:`runs`, each multiplied by ``scale`` and rounded."""
    return runs(round(value * scale) for value in values)


def position_steps(bounds: Box, points: Sequence[Sequence[float]], metre: float = 1.0) -> dict[str, str]:
    """Encode the ``x`` and the ``y`` coordinates of points, in centimetres of the map.

    The points are in metres of the level. ``metre`` says how many of these a metre on the map stands
    for.
    """
    return {
        "x": x_steps(bounds, [point[0] for point in points], metre),
        "y": y_steps(bounds, [point[1] for point in points], metre),
    }


def x_steps(bounds: Box, xs: Sequence[float], centimetres: float = 1) -> str:
    """Encode x coordinates, given in metres, with :func:`steps`.

    The encoded numbers are distances from the western bound; a unit is ``centimetres`` long.
    """
    return steps((x - bounds.low[0] for x in xs), 100 / centimetres)


def y_steps(bounds: Box, ys: Sequence[float], centimetres: float = 1) -> str:
    """Encode y coordinates, given in metres, with :func:`steps`.

    The encoded numbers are distances southwards from the northern bound; a unit is ``centimetres``
    long.
    """
    return steps((bounds.high[1] - y for y in ys), 100 / centimetres)
