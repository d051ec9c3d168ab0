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


def learn(discriminator: Discriminator, theirs: Decisions, agents: Decisions, penalty: float) -> list[float]:
    optimizer = torch.optim.Adam(discriminator.parameters(), lr=1e-2)
    losses = []
    for _ in range(150):
        judged = discriminator.judged(theirs, agents, penalty)
        optimizer.zero_grad()
        judged.loss.backward()
        optimizer.step()
        losses.append(judged.loss.item())
    return losses


@pytest.mark.parametrize(("shift", "action"), [(2.0, 0), (0.0, 2)], ids=["by observations", "by actions"])
def test_it_learns_to_tell_decisions_apart(discriminator: Discriminator, shift: float, action: int) -> None:
    theirs, agents = decisions(64), decisions(64, shift=shift, action=action)
    losses = learn(discriminator, theirs, agents, 0.0)
    judged = discriminator.judged(theirs, agents, 0.0)
    assert losses[0] == pytest.approx(2 * math.log(2), rel=0.3)
    assert losses[-1] < 0.3 * losses[0]
    assert judged.theirs > 0.8 > 0.2 > judged.agents
    assert discriminator.reward(theirs).mean() > 3 * discriminator.reward(agents).mean()


def test_equal_decisions_stay_undecided(discriminator: Discriminator) -> None:
    same = decisions(64)
    learn(discriminator, same, same, 1.0)
    judged = discriminator.judged(same, same, 0.0)
    assert judged.theirs == judged.agents == pytest.approx(0.5, abs=0.02)


def test_the_reward_is_a_function_of_the_probability(discriminator: Discriminator) -> None:
    sample = decisions(8)
    probability = discriminator(sample).sigmoid()
    assert torch.allclose(discriminator.reward(sample), -torch.log(1 - probability), atol=1e-6)
    assert (discriminator.reward(sample) >= 0).all()


def test_the_penalty_pulls_the_gradient_norm_towards_one(discriminator: Discriminator) -> None:
    theirs, agents = decisions(64), decisions(64, shift=3.0)

    def steepness(between: float) -> float:
        entities = torch.lerp(theirs[0]["entities"], agents[0]["entities"], between).requires_grad_()
        logits = discriminator(({**theirs[0], "entities": entities}, theirs[1]))
        return float(torch.autograd.grad(logits.sum(), entities)[0].norm(dim=1).mean())

    learn(discriminator, theirs, agents, 10.0)
    assert 0.5 < steepness(0.5) < 1.3
    free = learn(discriminator, theirs, agents, 0.0)
    assert free[-1] < 0.01
    assert steepness(0.5) > 1.3
