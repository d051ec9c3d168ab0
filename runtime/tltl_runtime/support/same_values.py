"""Copy and compare the values of games: observations and signals, also nested ones."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np


def is_same(first: Any, second: Any) -> bool:
    """Whether two values, or nested containers of values, are equal; NaN equals NaN."""
    if isinstance(first, Mapping) and isinstance(second, Mapping):
        return first.keys() == second.keys() and all(is_same(first[key], second[key]) for key in first)
    if isinstance(first, (tuple, list)) and isinstance(second, (tuple, list)):
        return len(first) == len(second) and all(map(is_same, first, second))
    one, other = np.asarray(first), np.asarray(second)
    if one.shape != other.shape:
        return False
    return bool(np.array_equal(one, other, equal_nan=one.dtype.kind in "fc" and other.dtype.kind in "fc"))


def copied(value: Any) -> Any:
    """Return a copy of nested containers of arrays: games may reuse their arrays."""
    if isinstance(value, Mapping):
        return {key: copied(item) for key, item in value.items()}
    if isinstance(value, (tuple, list)):
        return [copied(item) for item in value] if isinstance(value, list) else tuple(map(copied, value))
    return value.copy() if isinstance(value, np.ndarray) else value


def other_name(first: Mapping[str, Any], second: Mapping[str, Any]) -> str | None:
    """Return the first name whose values differ, or that only one of the mappings has; None if there is none."""
    names = (*first, *(name for name in second if name not in first))
    return next((name for name in names if not is_same(first.get(name), second.get(name))), None)
