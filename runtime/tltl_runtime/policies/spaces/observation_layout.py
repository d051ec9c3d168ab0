"""The layout of an observation: its parts in order, and what their numbers mean."""

from __future__ import annotations

from collections.abc import Iterator
from math import prod
from typing import Any, Final, Literal

import numpy as np
from gymnasium import spaces

from tltl_runtime.policies.spaces.refusals import SpaceRefusedError, name_of, observation_error
from tltlc.api import record

PartKind = Literal["numbers", "categories", "image", "grid"]
"""What a part consists of.

``numbers``: a vector of numbers. ``categories``: indices, which become one-hot vectors. ``image``:
brightness or another quantity in the cells of a rectangle. ``grid``: a category, from 0 to 255, in
the cells of a rectangle.
"""

MAX_NUMBERS: Final = 1 << 16
"""The greatest size of a vector, and the greatest number of categories of a part."""
MAX_CELLS: Final = 1 << 18
"""The greatest number of cells of an image or grid, all planes together."""
_GRID_SIDE: Final = 32
"""An integer array is a grid of categories if both sides are shorter than this, because no camera is so coarse."""
_MOST_PLANES: Final = 4
"""An array of three axes has its planes first if its last axis is longer than this, and its first is not.

The first axis of an array of zeros and ones may have any length, because maps have a plane for each type of thing.
"""
_WIDEST: Final = 1e6
"""Bounds that are farther apart than this count as no bounds, because they say nothing about the values."""


@record
class ObservationPart:
    """A part of an observation.

    ``key`` is its name among the inputs of the network, such as ``arm/0``. ``path`` has the keys
    and indices that lead to it in the observation, such as ``("arm", "0")``. ``shape`` is the shape
    of its array: (n,) for numbers and categories, (height, width, planes) for images and grids, or
    (planes, height, width) if ``planes_first``. For each of n categories, ``sizes`` has the number
    of its possible values, and ``starts`` the least of them. ``low`` and ``high`` are the bounds of
    each number, None where there is none; an image has one pair of bounds for all cells.

    Raises:
        ValueError: the fields contradict each other, or a size is out of range.
    """

    key: str
    path: tuple[str, ...]
    kind: PartKind
    shape: tuple[int, ...]
    planes_first: bool = False
    sizes: tuple[int, ...] = ()
    starts: tuple[int, ...] = ()
    low: tuple[float | None, ...] = ()
    high: tuple[float | None, ...] = ()

    def __post_init__(self) -> None:
        is_vector = self.kind in ("numbers", "categories")
        count = prod(self.shape)
        if len(self.shape) != (1 if is_vector else 3) or min(self.shape) < 1:
            raise ValueError(f"the shape {list(self.shape)!r:.60} is not that of {self.kind}")
        if count > (MAX_NUMBERS if is_vector else MAX_CELLS):
            raise ValueError(f"the shape {list(self.shape)!r:.60} has too many numbers")
        bounds = {"numbers": count, "image": 1}.get(self.kind, 0)
        if len(self.low) != bounds or len(self.high) != bounds:
            raise ValueError(f"{self.kind} of this shape have {bounds} pairs of bounds")
        if any(low is not None and high is not None and low >= high for low, high in self.bounds):
            raise ValueError("a lower bound is not below its upper bound")
        if self.kind == "image" and (None in self.low or None in self.high):
            raise ValueError("an image needs bounds")
        indices = count if self.kind == "categories" else 0
        if not len(self.sizes) == len(self.starts) == indices or min(self.sizes, default=1) < 1:
            raise ValueError("`sizes` and `starts` must have a number for each index")
        if sum(self.sizes) > MAX_NUMBERS:
            raise ValueError("there are too many categories")

    @property
    def bounds(self) -> tuple[tuple[float | None, float | None], ...]:
        """The pair (low, high) of bounds of each number; a single pair for an image."""
        return tuple(zip(self.low, self.high, strict=True))

    @property
    def planes(self) -> int:
        """The number of planes of an image or grid."""
        return self.shape[0] if self.planes_first else self.shape[2]

    @property
    def sides(self) -> tuple[int, int]:
        """The height and the width of an image or grid."""
        return (self.shape[1], self.shape[2]) if self.planes_first else (self.shape[0], self.shape[1])


def observation_layout(space: spaces.Space[Any]) -> tuple[ObservationPart, ...]:
    """Return the layout of an observation space.

    Raises:
        TltlError: TLT0844, policies do not support the space; each unsupported part has a
            diagnostic.
    """
    refusals: list[SpaceRefusedError] = []
    parts = tuple(_parts(space, (), refusals))
    if not parts and not refusals:
        refusals.append(SpaceRefusedError((), "is empty"))
    if refusals:
        raise observation_error(space, refusals)
    return parts


def _parts(
    space: spaces.Space[Any], path: tuple[str, ...], refusals: list[SpaceRefusedError]
) -> Iterator[ObservationPart]:
    """Yield the parts of ``space``, which is at ``path``; append unsupported parts to ``refusals``."""
    if isinstance(space, (spaces.Dict, spaces.Tuple)):
        items = space.spaces.items() if isinstance(space, spaces.Dict) else enumerate(space.spaces)
        for key, inner in items:
            if isinstance(space, spaces.Dict) and not isinstance(key, str):
                refusals.append(SpaceRefusedError((*path, str(key)), "has a key that is not a text"))
                continue
            yield from _parts(inner, (*path, str(key)), refusals)
        return
    try:
        yield _part(space, path)
    except SpaceRefusedError as refusal:
        refusals.append(refusal)


def _part(space: spaces.Space[Any], path: tuple[str, ...]) -> ObservationPart:
    key = name_of(path) or "observation"
    if isinstance(space, spaces.Discrete):
        return _categories(key, path, (int(space.n),), (int(space.start),))
    if isinstance(space, spaces.MultiDiscrete):
        sizes, starts = (tuple(int(value) for value in array.ravel()) for array in (space.nvec, space.start))
        return _categories(key, path, sizes, starts)
    if isinstance(space, spaces.MultiBinary):
        _check_count(path, count := int(np.prod(space.shape)), MAX_NUMBERS)
        return ObservationPart(key, path, "numbers", (count,), low=(0.0,) * count, high=(1.0,) * count)
    if isinstance(space, spaces.Box):
        return _box(space, key, path)
    raise SpaceRefusedError(path, f"is a {type(space).__name__} space, which no network can read")


def _categories(key: str, path: tuple[str, ...], sizes: tuple[int, ...], starts: tuple[int, ...]) -> ObservationPart:
    _check_count(path, sum(sizes), MAX_NUMBERS)
    return ObservationPart(key, path, "categories", (len(sizes),), sizes=sizes, starts=starts)


def _box(space: spaces.Box, key: str, path: tuple[str, ...]) -> ObservationPart:
    shape: tuple[int, ...] = tuple(space.shape)
    is_whole = space.dtype is not None and np.issubdtype(space.dtype, np.integer)
    lows, highs = space.low.astype(np.float64), space.high.astype(np.float64)
    low, high = float(lows.min(initial=np.inf)), float(highs.max(initial=-np.inf))
    is_plane = len(shape) == 3 or (len(shape) == 2 and is_whole and min(shape) > 1)
    if is_plane and min(shape) > 0 and 0 < high - low <= _WIDEST:
        _check_count(path, prod(shape), MAX_CELLS)
        is_map = is_whole and (low, high) == (0.0, 1.0) and len(shape) == 3
        planes_first = len(shape) == 3 and (is_map or shape[0] <= _MOST_PLANES) and shape[2] > _MOST_PLANES
        shape = shape if len(shape) == 3 else (*shape, 1)
        sides = shape[1:] if planes_first else shape[:2]
        if is_whole and not is_map and max(sides) < _GRID_SIDE and low >= 0 and high <= 255:
            return ObservationPart(key, path, "grid", shape, planes_first)
        return ObservationPart(key, path, "image", shape, planes_first, low=(low,), high=(high,))
    _check_count(path, prod(shape), MAX_NUMBERS)
    pairs = [_useful(*pair) for pair in zip(lows.ravel().tolist(), highs.ravel().tolist(), strict=True)]
    low_bounds, high_bounds = zip(*pairs, strict=True)
    return ObservationPart(key, path, "numbers", (len(pairs),), low=low_bounds, high=high_bounds)


def _useful(low: float, high: float) -> tuple[float | None, float | None]:
    """Return the bounds if a number can be scaled by them, else (None, None).

    Infinite bounds, equal bounds, and bounds that are too far apart are of no use.
    """
    return (low, high) if 0 < high - low <= _WIDEST else (None, None)


def _check_count(path: tuple[str, ...], count: int, most: int) -> None:
    if count < 1:
        raise SpaceRefusedError(path, "has no numbers")
    if count > most:
        raise SpaceRefusedError(path, f"has {count:,} numbers, and a network can read at most {most:,}")
