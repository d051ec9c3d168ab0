"""The discriminator tells decisions of demonstrations and of the agent apart."""

from __future__ import annotations

import math

import pytest
import torch

from tltl_runtime.policies.network import Network, model_config
from tltl_runtime.training.imitation.discriminator import Decisions, Discriminator

SHAPES = {"entities": (3,), "map": (2, 7, 7)}
BRANCHES = 3, 2


def decisions(count: int, *, shift: float = 0.0, action: int = 0) -> Decisions:
    observations = {"entities": torch.randn(count, 3) + shift, "map": (torch.rand(count, 2, 7, 7) < 0.1).float()}
    return observations, torch.tensor([[float(action), 1.0]]).repeat(count, 1)


@pytest.fixture(name="discriminator")
def _discriminator() -> Discriminator:
    torch.manual_seed(0)
    return Discriminator(decisions(2)[0], BRANCHES, model_config(Network(hidden=(16, 16), channels=(4,)), SHAPES))


def learn(discriminator: Discriminator, demonstrations: Decisions, agent: Decisions, penalty: float) -> list[float]:
    optimizer = torch.optim.Adam(discriminator.parameters(), lr=1e-2)
    losses = []
    for _ in range(150):
        result = discriminator.loss(demonstrations, agent, penalty)
        optimizer.zero_grad()
        result.loss.backward()
        optimizer.step()
        losses.append(result.loss.item())
    return losses


@pytest.mark.parametrize(("shift", "action"), [(2.0, 0), (0.0, 2)], ids=["by observations", "by actions"])
def test_the_discriminator_learns_to_tell_decisions_apart(
    discriminator: Discriminator, shift: float, action: int
) -> None:
    demonstrations, agent = decisions(64), decisions(64, shift=shift, action=action)
    losses = learn(discriminator, demonstrations, agent, 0.0)
    result = discriminator.loss(demonstrations, agent, 0.0)
    assert losses[0] == pytest.approx(2 * math.log(2), rel=0.3)
    assert losses[-1] < 0.3 * losses[0]
    assert result.demonstration_probability > 0.8 > 0.2 > result.agent_probability
    assert discriminator.reward(demonstrations).mean() > 3 * discriminator.reward(agent).mean()


def test_the_discriminator_cannot_tell_equal_decisions_apart(discriminator: Discriminator) -> None:
    same = decisions(64)
    learn(discriminator, same, same, 1.0)
    result = discriminator.loss(same, same, 0.0)
    assert result.demonstration_probability == result.agent_probability == pytest.approx(0.5, abs=0.02)


def test_the_reward_is_a_function_of_the_probability(discriminator: Discriminator) -> None:
    sample = decisions(8)
    probability = discriminator(sample).sigmoid()
    assert torch.allclose(discriminator.reward(sample), -torch.log(1 - probability), atol=1e-6)
    assert (discriminator.reward(sample) >= 0).all()


def test_the_penalty_pulls_the_gradient_norm_towards_one(discriminator: Discriminator) -> None:
    demonstrations, agent = decisions(64), decisions(64, shift=3.0)

    def steepness(between: float) -> float:
        entities = torch.lerp(demonstrations[0]["entities"], agent[0]["entities"], between).requires_grad_()
        logits = discriminator(({**demonstrations[0], "entities": entities}, demonstrations[1]))
        return float(torch.autograd.grad(logits.sum(), entities)[0].norm(dim=1).mean())

    learn(discriminator, demonstrations, agent, 10.0)
    assert 0.5 < steepness(0.5) < 1.3
    free = learn(discriminator, demonstrations, agent, 0.0)
    assert free[-1] < 0.01
    assert steepness(0.5) > 1.3
