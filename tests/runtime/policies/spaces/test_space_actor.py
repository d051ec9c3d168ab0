"""The network for any spaces: what its encoders get, and how large it is."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from gymnasium import spaces
from hypothesis import given
from hypothesis import strategies as st

from tests.runtime.policies.spaces.random_spaces import ACTIONS, OBSERVATIONS
from tests.runtime.policies.spaces.space_policies import SMALL, random_weights
from tltl_runtime.policies.network import Network
from tltl_runtime.policies.spaces.action_layout import action_layout
from tltl_runtime.policies.spaces.encoder_plan import convolutions, encoded_width, initial_scale
from tltl_runtime.policies.spaces.layouts import SpaceLayouts
from tltl_runtime.policies.spaces.observation_layout import observation_layout
from tltl_runtime.policies.spaces.space_actor import SpaceActor, planes_of
from tltl_runtime.policies.spaces.values import action_value, observation_arrays, squashed


@pytest.mark.hypothesis
@given(observation=OBSERVATIONS, action=ACTIONS, seed=st.integers(0, 2**31 - 1))
def test_a_network_chooses_actions_of_any_space(
    observation: spaces.Space[Any], action: spaces.Space[Any], seed: int
) -> None:
    layouts = SpaceLayouts(observation_layout(observation), action_layout(action))
    actor = SpaceActor(SMALL, layouts, random_weights(SMALL, layouts, seed))
    observation.seed(seed)
    arrays = observation_arrays(layouts.observation, observation.sample())
    outputs = actor.outputs(arrays)
    assert outputs.shape == (layouts.action.output_width,)
    assert outputs.dtype == np.float32
    for generator in (None, np.random.default_rng(seed)):
        flat = squashed(layouts.action, actor.choose(outputs, generator))
        assert action.contains(action_value(layouts.action, flat))


def test_a_grid_is_read_bit_by_bit_and_an_image_by_brightness() -> None:
    (grid,) = observation_layout(spaces.Box(0, 255, (2, 1, 2), np.uint8))
    bits = planes_of(grid, np.array([[[1, 2]], [[255, 8]]], np.uint8))
    assert bits.shape == (16, 2, 1)
    assert bits[:, 0, 0].tolist() == [1, *[0] * 7, 0, 1, *[0] * 6]
    assert bits[:, 1, 0].tolist() == [*[1] * 8, 0, 0, 0, 1, *[0] * 4]
    (image,) = observation_layout(spaces.Box(0, 255, (40, 40, 1), np.uint8))
    assert planes_of(image, np.full((40, 40, 1), 51, np.uint8))[0, 0, 0] == pytest.approx(0.2)


def test_bounds_are_scaled_to_minus_one_and_one() -> None:
    space = spaces.Box(np.array([0.0, -3.0, -np.inf]), np.array([10.0, 7.0, 5.0]), dtype=np.float64)
    layouts = SpaceLayouts(observation_layout(space), action_layout(spaces.Discrete(2)))
    assert initial_scale(layouts) == ([5.0, 2.0, 0.0], [5.0, 5.0, 1.0])


@pytest.mark.parametrize(
    ("shape", "strides"),
    [
        ((7, 7, 3), [1, 1]),
        ((19, 19, 3), [1, 2]),
        ((84, 84, 3), [2, 2, 2, 2]),
        ((240, 320, 3), [2] * 5),
        ((32, 32), [2, 2]),
    ],
)
def test_convolutions_leave_at_most_ten_cells(shape: tuple[int, ...], strides: list[int]) -> None:
    (part,) = observation_layout(spaces.Box(0, 255, shape, np.uint8))
    assert [layer.stride for layer in convolutions(part, Network())] == strides
    layouts = SpaceLayouts((part,), action_layout(spaces.Discrete(2)))
    assert encoded_width(layouts, Network()) <= 32 * 100
