"""Positions as games return them, and the entities of an episode."""

from __future__ import annotations

from math import inf, nan
from typing import Any

import numpy as np
import pytest

from tltl_runtime.gymnasium_games.entity_positions import PositionsError, entity_positions, read_positions


def test_an_entity_without_a_position_is_gone() -> None:
    value = {"player": (1, 2), "key": None, "bat": np.array([1.0, 2.0, 3.0]), "ghost": (nan, 0.0)}
    assert read_positions(value) == {"player": (1.0, 2.0, 0.0), "bat": (1.0, 2.0, 3.0)}


@pytest.mark.parametrize(
    ("value", "problem"),
    [
        ([("player", (0, 0))], "returns a list, not a mapping"),
        ({"key": 3}, "gives no position of `key`"),
        ({"key": (1.0,)}, "gives no position of `key`"),
        ({"key": (1.0, inf)}, "gives no position of `key`"),
        ({"key": "ab"}, "gives no position of `key`"),
        ({"": (1.0, 2.0)}, "names an entity ''"),
        ({str(number): (0, 0) for number in range(1001)}, "names 1,001 entities"),
    ],
)
def test_wrong_positions_are_refused(value: Any, problem: str) -> None:
    with pytest.raises(PositionsError) as caught:
        read_positions(value)
    assert str(caught.value).startswith(problem)
    assert caught.value.help


def test_entities_have_places_from_their_first_moment_on() -> None:
    moments = [{"player": (0.0, 0.0, 0.0), "key": (1.0, 1.0, 0.0)}, {"bat": (2.0, 2.0, 0.0)}, {"bat": (3.0, 2.0, 0.0)}]
    entities = entity_positions(moments)
    assert entities.names == ("key", "bat")
    assert np.isnan(entities.places[:, :, 0]).tolist() == [[False, True], [True, False], [True, False]]
    assert entities.still() == {"key": (1.0, 1.0, 0.0)}, "the bat moved"


def test_an_episode_has_a_limited_number_of_names() -> None:
    with pytest.raises(PositionsError, match="has named 1,001 entities"):
        entity_positions([{f"bullet_{step}": (0.0, 0.0, 0.0)} for step in range(1001)])
