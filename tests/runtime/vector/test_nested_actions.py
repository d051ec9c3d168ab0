"""Nested actions pass through the memory that workers share, and arrive as the values of their space."""

from __future__ import annotations

import multiprocessing
from functools import partial
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium import spaces
from hypothesis import given
from hypothesis import strategies as st

from tests.runtime.policies.spaces.random_spaces import ACTIONS, OBSERVATIONS
from tltl_runtime.policies.spaces.action_layout import action_layout
from tltl_runtime.policies.spaces.values import action_value, batch_row, flat_action
from tltl_runtime.vector import WorkerVectorEnv
from tltl_runtime.vector.actions import check_batch
from tltl_runtime.vector.shared_memory import Rows, read, write, write_batch

MIXED = spaces.Dict(
    {
        "go": spaces.Tuple((spaces.Box(-2, 5, (2,), np.float32), spaces.MultiBinary([2, 2]))),
        "use": spaces.Discrete(3, start=1),
        "aim": spaces.MultiDiscrete([[2, 3], [4, 5]]),
    }
)


@pytest.mark.hypothesis
@given(space=ACTIONS, observation=OBSERVATIONS, seed=st.integers(0, 2**31 - 1), count=st.integers(1, 3))
def test_a_batch_of_flat_actions_arrives_row_by_row(
    space: spaces.Space[Any], observation: spaces.Space[Any], seed: int, count: int
) -> None:
    space.seed(seed)
    observation.seed(seed)
    layout = action_layout(space)
    flat = np.stack([flat_action(layout, space.sample()) for _ in range(count)])
    batch = action_value(layout, flat, count)
    check_batch(space, batch, count)
    rows = Rows(multiprocessing.get_context(), count, observation, space, {})
    write_batch(rows.action, batch)
    arrived = read(rows.action, slice(0, count))
    seen = [observation.sample() for _ in range(count)]
    for row in range(count):
        action = read(arrived, row)
        assert space.contains(action)
        assert (flat_action(layout, action) == flat[row]).all()
        write(rows.observation, row, seen[row])
    every = read(rows.observation, slice(None))
    for row in range(count):
        np.testing.assert_equal(batch_row(every, row), seen[row])


class Echo(gymnasium.Env[Any, Any]):
    """An environment whose observation is the last action."""

    observation_space = MIXED
    action_space = MIXED

    def reset(self, *, seed: int | None = None, options: Any = None) -> tuple[Any, dict[str, Any]]:
        super().reset(seed=seed)
        self.action_space.seed(seed)
        return self.action_space.sample(), {}

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        assert MIXED.contains(action)
        return action, 0.0, False, False, {}


def test_workers_take_nested_actions() -> None:
    layout = action_layout(MIXED)
    env = WorkerVectorEnv([partial(Echo)] * 3, 2, info={})
    env.reset(seed=1)
    MIXED.seed(5)
    flat = np.stack([flat_action(layout, MIXED.sample()) for _ in range(3)])
    observation, *_ = env.step(action_value(layout, flat, 3))
    env.close()
    assert (flat_action(layout, observation, 3) == flat).all()
