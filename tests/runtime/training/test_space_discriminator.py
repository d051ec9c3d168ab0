"""The discriminator for any spaces tells decisions of demonstrations and of the agent apart."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import torch
from gymnasium import spaces
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.runtime.policies.spaces.random_spaces import ACTIONS, OBSERVATIONS
from tests.runtime.policies.spaces.space_policies import SMALL
from tests.runtime.training.test_discriminator import learn
from tltl_runtime.policies.spaces.action_layout import action_layout
from tltl_runtime.policies.spaces.layouts import SpaceLayouts
from tltl_runtime.policies.spaces.observation_layout import observation_layout
from tltl_runtime.policies.spaces.values import flat_action, squashed, unsquashed
from tltl_runtime.training.exploration.observation_encoding import ObservationEncoding
from tltl_runtime.training.imitation.discriminator import Decisions
from tltl_runtime.training.imitation.space_discriminator import SpaceDiscriminator

SEEDS = st.integers(0, 2**31 - 1)
OBSERVATION = spaces.Dict({"grid": spaces.Box(0, 9, (4, 4, 2), np.uint8), "x": spaces.Box(-np.inf, np.inf, (1,))})
ACTION = spaces.Tuple((spaces.Discrete(3), spaces.Box(-1, 4, (2,), np.float32)))


def decisions(
    layouts: SpaceLayouts, observation: spaces.Space[Any], action: spaces.Space[Any], count: int
) -> Decisions:
    encoding = ObservationEncoding(layouts)
    seen = encoding.tensors(encoding.stacked([observation.sample() for _ in range(count)]))
    flat = np.stack([flat_action(layouts.action, action.sample()) for _ in range(count)])
    return seen, torch.from_numpy(unsquashed(layouts.action, flat)).float()


@pytest.mark.hypothesis
@given(observation=OBSERVATIONS, action=ACTIONS, seed=SEEDS)
@settings(max_examples=30)
def test_decisions_of_any_spaces_have_a_loss_and_a_gradient(
    observation: spaces.Space[Any], action: spaces.Space[Any], seed: int
) -> None:
    layouts = SpaceLayouts(observation_layout(observation), action_layout(action))
    observation.seed(seed)
    action.seed(seed)
    discriminator = SpaceDiscriminator(layouts, SMALL)
    result = discriminator.loss(
        decisions(layouts, observation, action, 3), decisions(layouts, observation, action, 3), 1.0
    )
    result.loss.backward()
    assert all(weight.grad is not None and weight.grad.isfinite().all() for weight in discriminator.parameters())


@pytest.mark.parametrize("column", [0, 1], ids=["by choices", "by numbers"])
def test_the_discriminator_learns_to_tell_actions_apart(column: int) -> None:
    torch.manual_seed(0)
    layouts = SpaceLayouts(observation_layout(OBSERVATION), action_layout(ACTION))
    discriminator = SpaceDiscriminator(layouts, SMALL)
    demonstrations, agent = (decisions(layouts, OBSERVATION, ACTION, 32) for _ in range(2))
    demonstrations[1][:, column], agent[1][:, column] = 0.0, 1.0
    learn(discriminator, demonstrations, agent, 0.0)
    result = discriminator.loss(demonstrations, agent, 0.0)
    assert result.demonstration_probability > 0.8 > 0.2 > result.agent_probability


@pytest.mark.hypothesis
@given(space=ACTIONS, seed=SEEDS)
def test_flat_actions_make_the_round_trip_through_outputs(space: spaces.Space[Any], seed: int) -> None:
    space.seed(seed)
    layout = action_layout(space)
    flat = flat_action(layout, space.sample())
    outputs = unsquashed(layout, flat)
    assert np.isfinite(outputs).all()
    widths = [1 if low is None or high is None else high - low for low, high in layout.bounds]
    scale = np.array([1.0] * len(layout.sizes) + widths)
    assert (abs(squashed(layout, outputs) - flat) <= 1e-6 * scale).all()
