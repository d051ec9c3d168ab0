"""What changes over time, packed into few numbers; ``packing.js`` unpacks it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import groupby
from typing import Final, TypeVar

from tltl_runtime.stealth.level import Box

T = TypeVar("T")

_DIGITS: Final = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/"
_MORE: Final = 32


def steps(values: Iterable[float], scale: float) -> str:
    """Values times ``scale`` as whole numbers, in few letters: the first one, then what each is more than the last.

    A number is written as in source maps (base 64 VLQ): its sign is the lowest bit, digits of five bits follow each
    other from the lowest one, and all but the last have the sixth bit.
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
    """Values that change rarely, as pairs: a value, and how often it stands there one after the other."""
    return [[value, sum(1 for _ in same)] for value, same in groupby(values)]


def across(bounds: Box, xs: Sequence[float], centimetres: int = 1) -> str:
    """:func:`steps` of x from the western bound, in so many centimetres."""
    return steps((x - bounds.low[0] for x in xs), 100 / centimetres)


def down(bounds: Box, ys: Sequence[float], centimetres: int = 1) -> str:
    """:func:`steps` of y from the northern bound, southwards as on a screen, in so many centimetres."""
    return steps((bounds.high[1] - y for y in ys), 100 / centimetres)
