"""Untrained policies: the cards of real levels, with random weights."""

from __future__ import annotations

from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray

from tltl_runtime.game.sensors import SensorChoice
from tltl_runtime.policies.card import Card
from tltl_runtime.policies.network import Network
from tltl_runtime.policies.policy import Policy
from tltl_runtime.policies.torch_actor import arrays, new_actor
from tltl_runtime.stealth.env import make_env
from tltl_runtime.stealth.levels.identity import level_hash
from tltlc.monitor import RewardOptions

SMALL = Network(hidden=(32, 32), channels=(4, 4))


def card_of(
    level: str = "cover_and_hide",
    variant: str = "v0",
    sensors: SensorChoice | None = None,
    network: Network = SMALL,
    spec: str | None = None,
) -> Card:
    env = make_env(level, variant, spec, sensors=sensors)
    loaded_level = env.get_wrapper_attr("level")
    card = Card(
        level=loaded_level.name,
        variant=loaded_level.variant,
        level_hash=level_hash(loaded_level),
        fspa=env.task.fspa,
        params={},
        reward=RewardOptions(),
        sensors=env.unwrapped._observer.sensors,  # type: ignore[attr-defined]
        shapes=tuple((key, space.shape) for key, space in env.observation_space.spaces.items()),  # type: ignore[attr-defined]
        branches=(3, 3, 2, 2, 2),
        network=network,
        versions={"tltlc": "0"},
        training={"seed": 3, "curve": [[1, 0.5], [2, None]], "done": True},
    )
    env.close()
    return card


def policy_of(card: Card, seed: int = 0, sharpness: float = 50.0) -> Policy:
    """Return a policy with clear preferences: the choices of a new actor are nearly uniform."""
    torch.manual_seed(seed)
    actor = new_actor(card)
    with torch.no_grad():
        actor.mlp[-1].weight.mul_(sharpness)
        actor.mlp[-1].bias.uniform_(-1, 1)
    return Policy(card, arrays(actor.state_dict()))


def observation_of(card: Card, rng: np.random.Generator, batch: tuple[int, ...] = ()) -> dict[str, NDArray[Any]]:
    """Return a random observation: values in [-1, 1], and zeros and ones in maps."""
    return {
        key: (
            rng.integers(0, 2, (*batch, *shape), dtype=np.uint8)
            if len(shape) == 3
            else rng.uniform(-1, 1, (*batch, *shape)).astype(np.float32)
        )
        for key, shape in card.shapes
    }
