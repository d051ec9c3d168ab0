from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.runtime.gymnasium_games import games
from tltl_runtime.gymnasium_games.capabilities import capabilities
from tltl_runtime.gymnasium_games.game_file import read_game_file
from tltl_runtime.gymnasium_games.plays import (
    PlayedMoment,
    drawn_actions,
    first_difference,
    first_other_observation,
    play,
)
from tltl_runtime.gymnasium_games.scene_env import SceneEnv, make_base_env
from tltl_runtime.support.same_values import is_same


@pytest.fixture(name="env")
def _env(tmp_path: Path) -> SceneEnv:
    return make_base_env(read_game_file(games.write(tmp_path)), "short")


def test_equal_seeds_give_equal_actions_and_plays(env: SceneEnv) -> None:
    actions = drawn_actions(env)
    assert len(actions) == 200
    assert actions == drawn_actions(env) != drawn_actions(env, seed=2)
    first, second = play(env, actions).moments, play(env, actions).moments
    assert sum(moment.ended for moment in first) > 1
    assert first_difference(first, second) is None
    assert first_other_observation(first, second) is None
    other = play(env, actions[::-1]).moments
    assert first_difference(first, other) is not None
    assert first_other_observation(first, other) is not None


def test_the_first_difference_is_found(env: SceneEnv) -> None:
    moments = [PlayedMoment(step, {"x": np.array([step])}, {"a": 1.0, "b": step > 2}, False) for step in range(5)]
    changed = [*moments[:3], PlayedMoment(3, {"x": np.array([3])}, {"a": 1.0, "b": False, "c": 0}, False), *moments[4:]]
    difference = first_difference(moments, changed)
    assert difference is not None
    assert (difference.step, difference.name, difference.first, difference.second) == (3, "b", True, False)
    difference = first_difference(moments, [*moments[:4], PlayedMoment(4, None, {}, True)])
    assert difference is not None
    assert (difference.step, difference.name) == (4, "")
    assert first_other_observation(moments, [*moments[:2], PlayedMoment(2, {"x": np.array([7])}, {}, False)]) == 2


VALUES = st.recursive(
    st.none() | st.booleans() | st.integers(-5, 5) | st.floats() | st.text(max_size=3),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=2), inner, max_size=3),
    max_leaves=8,
)


@given(value=VALUES)
def test_a_value_is_the_same_as_itself_and_not_as_one_with_more(value: object) -> None:
    assert is_same(value, value)
    assert not is_same([value], [value, value])
    assert not is_same({"a": value}, {"b": value})


def test_capabilities_are_found_through_wrappers(env: SceneEnv, tmp_path: Path) -> None:
    assert capabilities(env) == ("clock", "render")
    methods = "".join(
        f"    def tltl_{name}(self, *_):\n        return {{}}\n\n"
        for name in ("params", "positions", "outline", "cause", "snapshot", "restore", "expert")
    )
    text = games.GRID.replace("    def render(self):", f"{methods}    def render(self):")
    other = make_base_env(read_game_file(games.write(tmp_path / "all", corridor__py=text)), "short")
    assert set(capabilities(other)) == {
        *("params", "clock", "positions", "outline", "cause", "snapshot", "expert", "render")
    }
