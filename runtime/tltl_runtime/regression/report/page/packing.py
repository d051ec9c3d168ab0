"""Compact encodings of values over time; ``packing.js`` decodes them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import groupby
from typing import Final, TypeVar

from tltl_runtime.game.geometry import Box

T = TypeVar("T")

_DIGITS: Final = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/"
_MORE: Final = 32


def steps(values: Iterable[float], scale: float) -> str:
    """Encode values times ``scale``, rounded to integers: the first value, then the differences.

    Numbers are encoded as in source maps (base64 VLQ): the lowest bit is the sign, the digits have five
    bits each, lowest first, and all but the last digit have the sixth bit set.
    """
    whole = [round(value * scale) for value in values]
    return "".join(_written(after - before) for before, after in zip([0, *whole], whole, strict=False))


def _written(number: int) -> str:
    left, digits = abs(number) << 1 | (number < 0), ""
    while left >= _MORE:
        digits += _DIGITS[left % _MORE + _MORE]
        left //= _MORE
    return digits + _DIGITS[left]


def runs(values: Iterable[T]) -> list[list[T | int]]:
    """Run-length encode values, as pairs of a value and its number of repetitions."""
    return [[value, sum(1 for _ in same)] for value, same in groupby(values)]


def across(bounds: Box, xs: Sequence[float], centimetres: int = 1) -> str:
    """:func:`steps` of x from the western bound, in units of ``centimetres``."""
    return steps((x - bounds.low[0] for x in xs), 100 / centimetres)


def down(bounds: Box, ys: Sequence[float], centimetres: int = 1) -> str:
    """:func:`steps` of y from the northern bound, southwards as on a screen, in units of ``centimetres``."""
    return steps((bounds.high[1] - y for y in ys), 100 / centimetres)
