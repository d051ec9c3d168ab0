"""Gymnasium spaces as texts and as JSON data."""

from __future__ import annotations

from typing import Any

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray


def space_text(space: spaces.Space[Any]) -> str:
    """Return a space in one line, such as ``Dict(image: Box(7 x 7 x 3, uint8, 0 to 255), direction: Discrete(4))``."""
    match space:
        case spaces.Dict():
            return f"Dict({', '.join(f'{key}: {space_text(part)}' for key, part in space.spaces.items())})"
        case spaces.Tuple():
            return f"Tuple({', '.join(map(space_text, space.spaces))})"
        case spaces.Box():
            shape, low, high = " x ".join(map(str, space.shape)) or "a number", _least(space.low), _greatest(space.high)
            bounds = "unbounded" if np.isinf([low, high]).all() else f"{low:g} to {high:g}"
            return f"Box({shape}, {space.dtype}, {bounds})"
        case spaces.Discrete():
            return f"Discrete({space.n})" if space.start == 0 else f"Discrete({space.n}, from {space.start})"
        case spaces.MultiDiscrete():
            return f"MultiDiscrete({', '.join(str(number) for number in space.nvec.reshape(-1).tolist())})"
        case spaces.MultiBinary():
            return f"MultiBinary({' x '.join(map(str, space.shape))})"
    return type(space).__name__


def space_json(space: spaces.Space[Any]) -> dict[str, Any]:
    """Return a space as JSON data: ``{"type": "discrete", "n": 4, "start": 0}``.

    ``low`` and ``high`` of a box are each a number if all elements have the same bound, else nested
    lists. None stands for an infinite bound. A space of an unknown type has only its ``type``.
    """
    match space:
        case spaces.Dict():
            return {"type": "dict", "spaces": {key: space_json(part) for key, part in space.spaces.items()}}
        case spaces.Tuple():
            return {"type": "tuple", "spaces": list(map(space_json, space.spaces))}
        case spaces.Box():
            bounds = {"low": _bound(space.low), "high": _bound(space.high)}
            return {"type": "box", **bounds, "shape": list(space.shape), "dtype": str(space.dtype)}
        case spaces.Discrete():
            return {"type": "discrete", "n": int(space.n), "start": int(space.start)}
        case spaces.MultiDiscrete():
            return {"type": "multi_discrete", "nvec": space.nvec.tolist()}
        case spaces.MultiBinary():
            return {"type": "multi_binary", "n": list(space.shape) if len(space.shape) > 1 else space.shape[0]}
    return {"type": type(space).__name__.lower()}


def _bound(bound: NDArray[Any]) -> Any:
    values = bound.reshape(-1)
    if values.size and (values == values[0]).all():
        return _finite(values[0].item())
    return _nested(bound.tolist())


def _nested(value: Any) -> Any:
    return [_nested(item) for item in value] if isinstance(value, list) else _finite(value)


def _finite(value: Any) -> Any:
    return value if np.isfinite(value) else None


def _least(bound: NDArray[Any]) -> float:
    return float(bound.min()) if bound.size else float("-inf")


def _greatest(bound: NDArray[Any]) -> float:
    return float(bound.max()) if bound.size else float("inf")
