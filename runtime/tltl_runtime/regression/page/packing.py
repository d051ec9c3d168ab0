"""What changes over time, packed into few numbers; ``packing.js`` unpacks it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import groupby
from typing import TypeVar

from tltl_runtime.stealth.level import Box

T = TypeVar("T")


def steps(values: Iterable[float], scale: float) -> list[int]:
    """Values times ``scale`` as whole numbers: the first one, then by how much each differs from the one before."""
    whole = [round(value * scale) for value in values]
    return [after - before for before, after in zip([0, *whole], whole, strict=False)]


def runs(values: Iterable[T]) -> list[list[T | int]]:
    """Values that change rarely, as pairs: a value, and how often it stands there one after the other."""
    return [[value, sum(1 for _ in same)] for value, same in groupby(values)]


def across(bounds: Box, xs: Sequence[float]) -> list[int]:
    """:func:`steps` of x, in centimetres from the western bound."""
    return steps((x - bounds.low[0] for x in xs), 100)


def down(bounds: Box, ys: Sequence[float]) -> list[int]:
    """:func:`steps` of y, in centimetres from the northern bound, southwards as on a screen."""
    return steps((bounds.high[1] - y for y in ys), 100)
