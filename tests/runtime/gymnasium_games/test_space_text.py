from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest
from gymnasium import spaces

from tltl_runtime.gymnasium_games.space_text import space_json, space_text

BOX = spaces.Box(np.array([0.0, -np.inf], np.float32), np.array([1.0, 5.0], np.float32))


@pytest.mark.parametrize(
    ("space", "text", "data"),
    [
        (spaces.Discrete(4), "Discrete(4)", {"type": "discrete", "n": 4, "start": 0}),
        (spaces.Discrete(4, start=1), "Discrete(4, from 1)", {"type": "discrete", "n": 4, "start": 1}),
        (spaces.MultiDiscrete([3, 2]), "MultiDiscrete(3, 2)", {"type": "multi_discrete", "nvec": [3, 2]}),
        (spaces.MultiBinary(5), "MultiBinary(5)", {"type": "multi_binary", "n": 5}),
        (spaces.MultiBinary([2, 3]), "MultiBinary(2 x 3)", {"type": "multi_binary", "n": [2, 3]}),
        (
            spaces.Box(0, 255, (7, 7, 3), np.uint8),
            "Box(7 x 7 x 3, uint8, 0 to 255)",
            {"type": "box", "low": 0, "high": 255, "shape": [7, 7, 3], "dtype": "uint8"},
        ),
        (
            BOX,
            "Box(2, float32, -inf to 5)",
            {"type": "box", "low": [0.0, None], "high": [1.0, 5.0], "shape": [2], "dtype": "float32"},
        ),
        (
            spaces.Box(-np.inf, np.inf, ()),
            "Box(a number, float32, unbounded)",
            {"type": "box", "low": None, "high": None, "shape": [], "dtype": "float32"},
        ),
        (spaces.Text(9), "Text", {"type": "text"}),
    ],
)
def test_a_space_is_shown_to_people_and_programs(space: spaces.Space[Any], text: str, data: dict[str, Any]) -> None:
    assert space_text(space) == text
    assert space_json(space) == data
    both = spaces.Dict({"a": space, "b": spaces.Tuple((space, spaces.Discrete(2)))})
    assert space_text(both) == f"Dict(a: {text}, b: Tuple({text}, Discrete(2)))"
    pair = {"type": "tuple", "spaces": [data, {"type": "discrete", "n": 2, "start": 0}]}
    assert space_json(both) == {"type": "dict", "spaces": {"a": data, "b": pair}}
    json.dumps(space_json(both), allow_nan=False)
