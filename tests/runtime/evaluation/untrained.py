"""Untrained policies: the weights are random, and so large that the choices are not uniform."""

from __future__ import annotations

import torch

from tltl_runtime.policies.card import Card
from tltl_runtime.policies.network import Network
from tltl_runtime.policies.policy import Policy
from tltl_runtime.policies.torch_actor import arrays, new_actor
from tltl_runtime.spec.wrapper import TltlEnv
from tltl_runtime.stealth.env import make_env
from tltl_runtime.stealth.level import StealthLevel
from tltlc.monitor import RewardOptions

SOON = """\
import spatial
import stealth
entity exit
spec soon { limit 20 steps
  reach near(exit)
  keep alive
}
"""
"""A spec with a short limit."""


def untrained(spec: str | None = SOON, level: str = "cover_and_hide", variant: str = "v0", seed: int = 0) -> Policy:
    env = make_env(level, variant, spec)
    try:
        card = card_of(env)
    finally:
        env.close()
    with torch.random.fork_rng():
        torch.manual_seed(seed)
        actor = new_actor(card)
        with torch.no_grad():
            for weights in actor.parameters():
                weights.mul_(3.0)
    return Policy(card, arrays(actor.state_dict()))


def card_of(env: TltlEnv) -> Card:
    level: StealthLevel = env.unwrapped.level  # type: ignore[attr-defined]
    return Card(
        level=level.name,
        variant=level.variant,
        level_hash="0" * 64,
        fspa=env.task.fspa,
        params=env.task.params,
        reward=RewardOptions(),
        sensors=level.sensors,
        shapes=tuple((key, space.shape) for key, space in env.observation_space.spaces.items()),  # type: ignore[attr-defined]
        branches=tuple(int(count) for count in env.action_space.nvec),  # type: ignore[attr-defined]
        network=Network(hidden=(32,), channels=(4,)),
        versions={},
        training={},
    )
