"""Random spaces that policies can have."""

from __future__ import annotations

from typing import Any

import numpy as np
from gymnasium import spaces
from hypothesis import strategies as st


def _box(shape: tuple[int, ...], low: float, high: float, dtype: Any) -> spaces.Box:
    return spaces.Box(low, high, shape, dtype)


_SHORT = st.lists(st.integers(1, 4), min_size=1, max_size=2).map(tuple)
_BOUNDS = st.sampled_from([(-1.0, 1.0), (0.0, 10.0), (-3.0, 7.0), (-np.inf, np.inf), (0.0, np.inf), (-np.inf, 2.0)])
_BOXES = st.builds(
    lambda shape, bounds, dtype: _box(shape, bounds[0], bounds[1], dtype),
    _SHORT,
    _BOUNDS,
    st.sampled_from([np.float32, np.float64]),
)
_MIXED_BOXES = st.just(
    spaces.Box(np.array([-4.8, -np.inf, 0.0], np.float32), np.array([4.8, np.inf, 1.0], np.float32), dtype=np.float32)
)
_WHOLE_BOXES = st.builds(
    lambda shape, high, dtype: _box(shape, 0, high, dtype),
    _SHORT,
    st.integers(1, 100),
    st.sampled_from([np.int8, np.int64, np.uint8]),
)
_DISCRETE = st.builds(lambda n, start: spaces.Discrete(n, start=start), st.integers(1, 6), st.integers(-3, 3))
_MULTI_DISCRETE = st.lists(st.integers(1, 5), min_size=1, max_size=3).map(lambda sizes: spaces.MultiDiscrete(sizes))
_MULTI_BINARY = st.one_of(st.integers(1, 4), _SHORT.map(list)).map(lambda size: spaces.MultiBinary(size))
_IMAGES = st.sampled_from(
    [
        _box((5, 6, 3), 0, 255, np.uint8),
        _box((36, 40, 3), 0, 255, np.uint8),
        _box((33, 33), 0, 255, np.uint8),
        _box((3, 12, 11), 0, 255, np.uint8),
        _box((4, 7), 0, 9, np.int64),
        _box((6, 5, 2), -2.0, 3.0, np.float32),
        _box((2, 5, 5), 0, 1, np.uint8),
    ]
)
_VECTORS = st.one_of(_BOXES, _MIXED_BOXES, _WHOLE_BOXES, _DISCRETE, _MULTI_DISCRETE, _MULTI_BINARY)


def _nested(leaves: st.SearchStrategy[spaces.Space[Any]]) -> st.SearchStrategy[spaces.Space[Any]]:
    return st.recursive(
        leaves,
        lambda inner: st.one_of(
            st.dictionaries(st.sampled_from(["a", "b/c", "d~", "0"]), inner, min_size=1, max_size=3).map(spaces.Dict),
            st.lists(inner, min_size=1, max_size=3).map(spaces.Tuple),
        ),
        max_leaves=4,
    )


OBSERVATIONS = _nested(st.one_of(_VECTORS, _IMAGES))
"""Observation spaces, some of them nested."""
ACTIONS = _nested(_VECTORS)
"""Action spaces, some of them nested."""
