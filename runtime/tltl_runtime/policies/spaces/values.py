"""Convert observations to arrays by key, and flat actions to the values of a space and back.

A flat action is a vector: first all choices, which count from 0, then all continuous numbers.
``count`` is the number of environments of a batch; None means one environment without a batch axis.
A batch of a Dict or Tuple space is a mapping or tuple of batches, as in Gymnasium.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence, Set
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.policies.spaces.action_layout import ActionLayout, ActionPart
from tltl_runtime.policies.spaces.observation_layout import ObservationPart

_NEAR_BOUND: Final = 1 - 1e-6
"""The greatest hyperbolic tangent that :func:`unsquashed` inverts, because that of 1 would be infinite."""


def observation_arrays(
    layout: Sequence[ObservationPart], observation: Any, count: int | None = None
) -> dict[str, NDArray[Any]]:
    """Return the parts of an observation as arrays [count, *part.shape], by key.

    ``observation`` is a batch of ``count`` observations. If ``count`` is None, it is a single one,
    and the arrays have no batch axis. Grids, and images of bytes, are uint8; everything else is
    float32. Categories count from 0.
    """
    return {part.key: _array(part, _at(observation, part.path), count) for part in layout}


def batch_row(batch: Any, row: int) -> Any:
    """Return one element of a batch, the one with the index ``row``.

    A batch of a Dict or Tuple space is a mapping or tuple of batches, and so is the element.
    """
    if isinstance(batch, Mapping):
        return {key: batch_row(values, row) for key, values in batch.items()}
    return tuple(batch_row(values, row) for values in batch) if isinstance(batch, tuple) else batch[row]


def action_value(layout: ActionLayout, flat: NDArray[Any], count: int | None = None) -> Any:
    """Convert flat actions [count, width] to a batch of values of the action space.

    If ``count`` is None, convert one flat action [width] to one value.
    """
    choices, numbers = np.split(flat, [len(layout.sizes)], axis=-1)
    nested: dict[str, Any] = {}
    for part in layout.parts:
        size = len(part.sizes) + len(part.low)
        if part.kind == "numbers":
            taken, numbers = np.split(numbers, [size], axis=-1)
        else:
            taken, choices = np.split(choices, [size], axis=-1)
        value = _value(part, taken, count)
        if not part.path:
            return value
        node = nested
        for key in part.path[:-1]:
            node = node.setdefault(key, {})
        node[part.path[-1]] = value
    return _with_tuples(nested, (), set(layout.tuples))


def flat_action(layout: ActionLayout, action: Any, count: int | None = None) -> NDArray[np.float64]:
    """Convert a batch of ``count`` values of the action space to flat actions [count, width], in float64.

    If ``count`` is None, convert one value to one flat action [width].
    """
    rows = () if count is None else (count,)
    choices: list[NDArray[np.float64]] = []
    numbers: list[NDArray[np.float64]] = []
    for part in layout.parts:
        array = np.asarray(_at(action, part.path)).astype(np.float64).reshape(*rows, -1)
        if part.kind == "numbers":
            numbers.append(array)
        else:
            choices.append(array - np.array(part.starts))
    return np.concatenate([*choices, *numbers], axis=-1)


def squashed(layout: ActionLayout, outputs: NDArray[Any]) -> NDArray[np.float64]:
    """Return flat actions [..., width] for actions as a policy's network outputs them.

    ``outputs`` [..., width] has the choices and then the continuous numbers. A number with two
    bounds becomes its hyperbolic tangent, scaled to these bounds. A number with one bound is
    clipped there. All other entries stay the same.
    """
    flat: NDArray[np.float64] = np.array(outputs, np.float64)
    first = len(layout.sizes)
    for column, (low, high) in enumerate(layout.bounds, start=first):
        if low is not None and high is not None:
            flat[..., column] = low + (high - low) * (np.tanh(flat[..., column]) + 1) / 2
        flat[..., column] = np.clip(flat[..., column], low, high)
    return flat


def unsquashed(layout: ActionLayout, flat: NDArray[Any]) -> NDArray[np.float64]:
    """Return the outputs of a policy that :func:`squashed` maps to flat actions [..., width].

    A number at its bound would need an infinite output, so outputs of numbers with two bounds are
    limited to about 7 and -7.
    """
    outputs: NDArray[np.float64] = np.array(flat, np.float64)
    for column, (low, high) in enumerate(layout.bounds, start=len(layout.sizes)):
        if low is not None and high is not None:
            share = (outputs[..., column] - low) / (high - low) if high > low else np.full(outputs.shape[:-1], 0.5)
            outputs[..., column] = np.arctanh(np.clip(2 * share - 1, -_NEAR_BOUND, _NEAR_BOUND))
    return outputs


def _array(part: ObservationPart, value: Any, count: int | None) -> NDArray[Any]:
    array = np.asarray(value).reshape(part.shape if count is None else (count, *part.shape))
    if part.starts:
        array = array - np.array(part.starts)
    keeps_bytes = part.kind == "grid" or (part.kind == "image" and array.dtype in (np.uint8, np.bool_))
    return array.astype(np.uint8 if keeps_bytes else np.float32)


def _at(value: Any, path: Sequence[str]) -> Any:
    for key in path:
        value = value[key] if isinstance(value, Mapping) else value[int(key)]
    return value


def _value(part: ActionPart, flat: NDArray[Any], count: int | None) -> Any:
    """Return the value of a part of an action; ``flat`` has the entries of this part in flat actions."""
    dtype = np.dtype(part.dtype)
    if part.kind == "numbers":
        array = _in_type(part, flat, dtype)
    else:
        array = (flat.astype(np.int64) + np.array(part.starts, np.int64)).astype(dtype)
    if count is not None:
        return array.reshape(count, *part.shape)
    return array.reshape(part.shape)[()] if part.kind == "choice" else array.reshape(part.shape)


def _in_type(part: ActionPart, numbers: NDArray[Any], dtype: np.dtype[Any]) -> NDArray[Any]:
    """Convert numbers to the type of their Box, ``dtype``; clip them to its bounds after rounding."""
    info = np.finfo(dtype) if dtype.kind == "f" else np.iinfo(dtype)
    if dtype.kind != "f":
        numbers = np.rint(numbers)
    low, high = np.full(len(part.low), info.min, dtype), np.full(len(part.high), info.max, dtype)
    for column, (least, most) in enumerate(zip(part.low, part.high, strict=True)):
        low[column] = low[column] if least is None else dtype.type(least)
        high[column] = high[column] if most is None else dtype.type(most)
    # The greatest number of a type of 64 bits is not exact in float64, and would overflow.
    most_in_type = np.nextafter(float(info.max), 0) if dtype.itemsize == 8 else float(info.max)
    in_type: NDArray[Any] = np.clip(numbers, float(info.min), most_in_type).astype(dtype)
    return in_type.clip(low, high)


def _with_tuples(node: Any, path: tuple[str, ...], tuples: Set[tuple[str, ...]]) -> Any:
    """Return nested mappings, in which each mapping at one of the paths ``tuples`` becomes a tuple.

    Such a mapping has the keys ``"0"``, ``"1"``, and so on. ``path`` is the path of ``node``.
    """
    if not isinstance(node, dict):
        return node
    inner = {key: _with_tuples(value, (*path, key), tuples) for key, value in node.items()}
    return tuple(inner[str(index)] for index in range(len(inner))) if path in tuples else inner
