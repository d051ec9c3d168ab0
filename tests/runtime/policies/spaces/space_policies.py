"""Policies with random weights for any spaces."""

from __future__ import annotations

from typing import Any

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from tltl_runtime.game.sensors import Sensors
from tltl_runtime.policies.card import Card
from tltl_runtime.policies.network import Network
from tltl_runtime.policies.policy import Policy
from tltl_runtime.policies.spaces.encoder_plan import NORMALIZER, space_weight_shapes
from tltl_runtime.policies.spaces.layouts import SpaceLayouts, space_layouts
from tltl_runtime.spec.task import load_task
from tltlc.core.record import replace
from tltlc.monitor import RewardOptions

SMALL = Network(hidden=(8,), channels=(3, 4))
FSPA = load_task("signal health in [0, 1]\npredicate well in [-1, 1] = 2 * health - 1\nspec live { reach well }\n").fspa


def random_weights(network: Network, layouts: SpaceLayouts, seed: int) -> dict[str, NDArray[Any]]:
    """Return random weights; deviations and counts are above 0."""
    generator = np.random.default_rng(seed)
    shapes = space_weight_shapes(network, layouts)
    weights = {name: generator.uniform(-1, 1, shape).astype(np.float32) for name, shape in shapes.items()}
    positive = [f"{NORMALIZER}deviation", f"{NORMALIZER}count"]
    return weights | {name: abs(weights[name]) + 0.1 for name in positive if name in weights}


def card_of_spaces(observation: spaces.Space[Any], action: spaces.Space[Any], network: Network = SMALL) -> Card:
    layouts = space_layouts(observation, action)
    assert layouts is not None
    return Card(
        level="small",
        variant="v0",
        level_hash="0" * 64,
        fspa=FSPA,
        params={},
        reward=RewardOptions(),
        sensors=Sensors((), (), None),
        shapes=tuple(layouts.shapes.items()),
        branches=(),
        network=network,
        versions={"tltlc": "0"},
        training={},
        spaces=layouts,
    )


def policy_of_spaces(
    observation: spaces.Space[Any], action: spaces.Space[Any], seed: int = 0, network: Network = SMALL
) -> Policy:
    card = card_of_spaces(observation, action, network)
    assert card.spaces is not None
    return Policy(card, random_weights(network, card.spaces, seed))


def with_layouts(card: Card, **changes: Any) -> Card:
    assert card.spaces is not None
    return replace(card, spaces=replace(card.spaces, **changes))
