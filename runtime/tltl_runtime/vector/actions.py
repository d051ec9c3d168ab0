"""Check that a batch of actions has one action for each environment, before any action is sent."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from gymnasium import Space, spaces
from numpy.typing import NDArray


def check_batch(space: Space[Any], batch: Any, count: int) -> None:
    """Check that ``batch`` has ``count`` actions of ``space``, batched as Gymnasium does it.

    The range of a Box is not checked here; the environment does that.

    Raises:
        ValueError: the batch has another shape, keys or type, or a value outside the space.
    """
    if isinstance(space, spaces.Dict):
        if not isinstance(batch, Mapping) or batch.keys() != space.keys():
            raise ValueError(f"a batch of actions must have the keys {', '.join(space)}")
        for key, part in space.items():
            check_batch(part, batch[key], count)
        return
    if isinstance(space, spaces.Tuple):
        if len(batch) != len(space):
            raise ValueError(f"the number of parts of a batch of actions must be {len(space)}, not {len(batch)}")
        for part, values in zip(space, batch, strict=True):
            check_batch(part, values, count)
        return
    array = np.asarray(batch)
    shape = (count, *(space.shape or ()))
    if array.shape != shape:
        raise ValueError(f"a batch must have the shape {shape}, not {array.shape}")
    if not np.can_cast(array.dtype, np.dtype(space.dtype), "same_kind"):
        raise ValueError(f"actions of {space} must be {space.dtype}, not {array.dtype}")
    wrong = _outside_space(space, array).reshape(count, -1).any(axis=1)
    if wrong.any():
        row = int(wrong.argmax())
        raise ValueError(f"the action of env {row} is {array[row].tolist()}, which is not in {space}")


def _outside_space(space: Space[Any], values: NDArray[Any]) -> NDArray[np.bool_]:
    """Return a mask of ``values``: True where a number is not in the space; never for a Box."""
    if isinstance(space, (spaces.Discrete, spaces.MultiDiscrete)):
        size = space.n if isinstance(space, spaces.Discrete) else space.nvec
        return np.asarray((values < space.start) | (values >= space.start + size))
    if isinstance(space, spaces.MultiBinary):
        return np.asarray((values < 0) | (values > 1))
    return np.zeros(values.shape, dtype=np.bool_)
