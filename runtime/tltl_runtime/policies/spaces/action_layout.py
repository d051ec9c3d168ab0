"""The layout of an action: its parts in order, each with choices or numbers.

A *flat action* is a vector with an entry for each choice and each element of a Box: first all
choices, in the order of the parts, then all numbers. Choices count from 0. Numbers are within the
bounds of their Box.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import prod
from typing import Any, Final, Literal, get_args

import numpy as np
from gymnasium import spaces

from tltl_runtime.policies.spaces.refusals import SpaceRefusedError, action_error
from tltlc.api import record

ActionKind = Literal["choice", "choices", "numbers"]
"""``choice``: a Discrete space. ``choices``: MultiDiscrete or MultiBinary. ``numbers``: a Box."""

ActionDtype = Literal[
    "float16", "float32", "float64", "int8", "int16", "int32", "int64", "uint8", "uint16", "uint32", "uint64"
]

MAX_CHOICES: Final = 1 << 16
"""The greatest number of choices that all parts may have together."""
MAX_ELEMENTS: Final = 1 << 12
"""The greatest number of elements that all Boxes may have together."""
_GREATEST_BOUND: Final = 2.0**53
"""A bound beyond this number counts as no bound.

It is usually just the greatest number of a type, and float64 cannot represent it exactly.
"""


@record
class ActionPart:
    """A part of an action: the value of a Discrete, MultiDiscrete, MultiBinary or Box space.

    ``path`` has the keys and indices that lead to the part, such as ``("arm", "0")``; it is empty
    if the part is the whole action. ``shape`` and ``dtype`` are those of the value; the shape of a
    single choice is (). ``sizes`` has the number of choices of each element, ``starts`` the value
    of its first choice. ``low`` and ``high`` are the bounds of each number, None where there is
    none.

    Raises:
        ValueError: the fields contradict each other, or a size is out of range.
    """

    path: tuple[str, ...]
    kind: ActionKind
    shape: tuple[int, ...]
    dtype: ActionDtype
    sizes: tuple[int, ...] = ()
    starts: tuple[int, ...] = ()
    low: tuple[float | None, ...] = ()
    high: tuple[float | None, ...] = ()

    def __post_init__(self) -> None:
        if min(self.shape, default=1) < 1 or prod(self.shape) > MAX_CHOICES or (self.kind == "choice" and self.shape):
            raise ValueError(f"the shape {list(self.shape)!r:.60} is not that of {self.kind}")
        choices, numbers = (0, prod(self.shape)) if self.kind == "numbers" else (prod(self.shape), 0)
        if not len(self.sizes) == len(self.starts) == choices or not len(self.low) == len(self.high) == numbers:
            raise ValueError("choices or bounds are missing, or there are too many")
        if min(self.sizes, default=1) < 1:
            raise ValueError("each element needs at least one choice")
        pairs = zip(self.low, self.high, strict=True)
        if any(low is not None and high is not None and low > high for low, high in pairs):
            raise ValueError("a lower bound is above its upper bound")


@record
class ActionLayout:
    """The parts of an action, in order.

    An action may be nested: the part with the path ``("arm", "0")`` is at ``action["arm"][0]``.
    ``tuples`` are the paths of the tuples in an action, such as ``("arm",)``; all other inner nodes
    are mappings.

    Raises:
        ValueError: there are no parts, there are too many choices or numbers, or the paths
            contradict each other.
    """

    parts: tuple[ActionPart, ...]
    tuples: tuple[tuple[str, ...], ...] = ()

    def __post_init__(self) -> None:
        check_paths([part.path for part in self.parts], self.tuples)
        if not self.parts or sum(self.sizes) > MAX_CHOICES or self.number_count > MAX_ELEMENTS:
            raise ValueError("an action needs choices or numbers, but not too many")

    @property
    def sizes(self) -> tuple[int, ...]:
        """For each choice in a flat action, the number of values that it can have."""
        return tuple(size for part in self.parts for size in part.sizes)

    @property
    def number_count(self) -> int:
        """How many continuous numbers a flat action has, after its choices."""
        return sum(len(part.low) for part in self.parts)

    @property
    def bounds(self) -> tuple[tuple[float | None, float | None], ...]:
        """The pair (low, high) of bounds of each number in a flat action, None where there is none."""
        return tuple(pair for part in self.parts for pair in zip(part.low, part.high, strict=True))

    @property
    def width(self) -> int:
        """The length of a flat action."""
        return len(self.sizes) + self.number_count

    @property
    def output_width(self) -> int:
        """How many numbers a network outputs for an action: a logit for each choice, a mean for each number."""
        return sum(self.sizes) + self.number_count


def check_paths(paths: Sequence[tuple[str, ...]], tuples: Sequence[tuple[str, ...]]) -> None:
    """Raise ValueError if the paths of the parts of an action contradict each other.

    Paths must be different, and none may lead through another. ``tuples`` are the paths of the
    tuples in the action; the indices in each tuple must be 0, 1, and so on.
    """
    children: dict[tuple[str, ...], set[str]] = {}
    for path in paths:
        for length in range(len(path)):
            children.setdefault(path[:length], set()).add(path[length])
    if len(set(paths)) < len(paths) or any(path in children for path in paths):
        raise ValueError("two parts of an action have the same path")
    if any(children.get(path) != set(map(str, range(len(children.get(path, ()))))) for path in tuples):
        raise ValueError("a tuple of an action has other indices than 0, 1, and so on")


def action_layout(space: spaces.Space[Any]) -> ActionLayout:
    """Return the layout of an action space.

    Raises:
        TltlError: TLT0844, policies do not support the space; each unsupported part has a
            diagnostic.
    """
    refusals: list[SpaceRefusedError] = []
    parts = tuple(_parts(space, (), refusals))
    if not refusals:
        refusals += _total_refusals(parts)
    if refusals:
        raise action_error(refusals)
    return ActionLayout(parts, tuple(_tuples(space, ())))


def _tuples(space: spaces.Space[Any], path: tuple[str, ...]) -> Iterator[tuple[str, ...]]:
    """Yield the paths of all Tuple spaces in ``space``, which is at ``path``."""
    if isinstance(space, spaces.Tuple):
        yield path
    if isinstance(space, (spaces.Dict, spaces.Tuple)):
        for key, inner in space.spaces.items() if isinstance(space, spaces.Dict) else enumerate(space.spaces):
            yield from _tuples(inner, (*path, str(key)))


def _parts(space: spaces.Space[Any], path: tuple[str, ...], refusals: list[SpaceRefusedError]) -> Iterator[ActionPart]:
    """Yield the parts of ``space``, which is at ``path``; append unsupported parts to ``refusals``."""
    if isinstance(space, (spaces.Dict, spaces.Tuple)):
        items = space.spaces.items() if isinstance(space, spaces.Dict) else enumerate(space.spaces)
        if not space.spaces:
            refusals.append(SpaceRefusedError(path, "is empty"))
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


def _part(space: spaces.Space[Any], path: tuple[str, ...]) -> ActionPart:
    if isinstance(space, (spaces.Discrete, spaces.MultiDiscrete, spaces.MultiBinary, spaces.Box)):
        shape, dtype = tuple(space.shape or ()), _dtype(space, path)
        if not 1 <= prod(shape) <= MAX_CHOICES:
            raise SpaceRefusedError(path, f"has {prod(shape):,} elements, and 1 to {MAX_CHOICES:,} are possible")
    if isinstance(space, spaces.Discrete):
        return ActionPart(path, "choice", (), dtype, (int(space.n),), (int(space.start),))
    if isinstance(space, spaces.MultiDiscrete):
        sizes, starts = (tuple(int(value) for value in array.ravel()) for array in (space.nvec, space.start))
        return ActionPart(path, "choices", shape, dtype, sizes, starts)
    if isinstance(space, spaces.MultiBinary):
        return ActionPart(path, "choices", shape, dtype, (2,) * prod(shape), (0,) * prod(shape))
    if isinstance(space, spaces.Box):
        low, high = (
            tuple(float(value) if abs(float(value)) <= _GREATEST_BOUND else None for value in array.ravel())
            for array in (space.low, space.high)
        )
        return ActionPart(path, "numbers", shape, dtype, low=low, high=high)
    raise SpaceRefusedError(path, f"is a {type(space).__name__} space, which no policy can choose in")


def _dtype(space: spaces.Space[Any], path: tuple[str, ...]) -> ActionDtype:
    name = np.dtype(space.dtype).name
    for known in get_args(ActionDtype):
        if name == known:
            dtype: ActionDtype = known
            return dtype
    raise SpaceRefusedError(path, f"has values of the type {name}, which no policy can choose")


def _total_refusals(parts: Sequence[ActionPart]) -> Iterator[SpaceRefusedError]:
    choices, numbers = sum(sum(part.sizes) for part in parts), sum(len(part.low) for part in parts)
    if choices > MAX_CHOICES:
        yield SpaceRefusedError((), f"has {choices:,} choices, and at most {MAX_CHOICES:,} are possible")
    if numbers > MAX_ELEMENTS:
        yield SpaceRefusedError((), f"has {numbers:,} numbers, and at most {MAX_ELEMENTS:,} are possible")
