"""The choices of a policy: samples of its softmax, or the likeliest choice; they depend only on the observation."""

from __future__ import annotations

import pickle

import numpy as np
import pytest
import torch
from tensordict import TensorDict

from tests.runtime.policies.examples import card_of, observation_of, policy_of
from tltl_runtime.policies.network import Network
from tltl_runtime.policies.policy import Policy


@pytest.fixture(name="policy", scope="module", params=[{}, {"map": None}], ids=["map", "no_map"])
def _policy(request: pytest.FixtureRequest) -> Policy:
    return policy_of(card_of("cover_and_hide", sensors=request.param, network=Network()))


def test_the_logits_equal_the_logits_of_rsl_rl(policy: Policy) -> None:
    for seed in range(20):
        observation = observation_of(policy.card, np.random.default_rng(seed))
        batch = {key: torch.from_numpy(values).float().unsqueeze(0) for key, values in observation.items()}
        with torch.no_grad():
            action = policy.actor(TensorDict(batch, batch_size=[1]))
            policy.actor(TensorDict(batch, batch_size=[1]), stochastic_output=True)
        logits = torch.from_numpy(policy.logits(observation).copy())
        for part, log in zip(logits.split(policy.card.branches), policy.actor.output_distribution_params, strict=True):
            torch.testing.assert_close(part.log_softmax(-1), log[0], rtol=0, atol=0)
        assert policy.choose(observation).tolist() == action[0].tolist()


def test_samples_have_the_frequencies_of_the_softmax(policy: Policy) -> None:
    observation, generator, count = (
        observation_of(policy.card, np.random.default_rng(3)),
        np.random.default_rng(4),
        4000,
    )
    samples = np.array([policy.choose(observation, generator) for _ in range(count)])
    logits = torch.from_numpy(policy.logits(observation).copy())
    for column, part in enumerate(logits.split(policy.card.branches)):
        expected = part.double().softmax(-1).numpy()
        frequencies = np.bincount(samples[:, column], minlength=len(expected)) / count
        # Within five standard deviations of a share.
        assert (abs(frequencies - expected) <= 5 * np.sqrt(expected * (1 - expected) / count) + 1e-9).all()


def test_equal_generators_give_equal_choices(policy: Policy) -> None:
    observation = observation_of(policy.card, np.random.default_rng(3))
    first, second = (
        [policy.choose(observation, rng).tolist() for _ in range(50)] for rng in map(np.random.default_rng, (1, 1))
    )
    assert first == second
    assert len(set(map(tuple, first))) > 1


def test_the_first_of_equal_choices_is_chosen(policy: Policy) -> None:
    with torch.no_grad():
        flat = Policy(policy.card, policy.weights())
        flat.actor.mlp[-1].weight.zero_()
        flat.actor.mlp[-1].bias.zero_()
    observation = observation_of(policy.card, np.random.default_rng(3))
    assert flat.choose(observation).tolist() == [0, 0, 0, 0, 0]
    assert flat.choose(observation).dtype == np.int64


def test_choosing_has_no_side_effects(policy: Policy) -> None:
    """Choosing changes neither torch's generator, nor the policy, nor the observation; the policy can be pickled."""
    observation = observation_of(policy.card, np.random.default_rng(3))
    before = {key: values.copy() for key, values in observation.items()}
    state, logits = torch.get_rng_state(), policy.logits(observation)
    policy.choose(observation, np.random.default_rng(0))
    assert torch.equal(state, torch.get_rng_state())
    assert all((observation[key] == before[key]).all() for key in observation)
    assert (policy.logits(observation) == logits).all()
    assert not any(parameter.requires_grad for parameter in policy.actor.parameters())
    again = pickle.loads(pickle.dumps(policy))
    assert again.logits(observation).tobytes() == logits.tobytes()
    assert again.card == policy.card


def test_the_memory_layout_of_weights_does_not_count() -> None:
    policy = policy_of(card_of("cover_and_hide", network=Network()))
    weights = {
        name: weight.float().to(memory_format=torch.channels_last) if weight.dim() == 4 else weight.float()
        for name, weight in policy.weights().items()
    }
    copy = Policy(policy.card, weights)
    for seed in range(20):
        observation = observation_of(policy.card, np.random.default_rng(seed))
        assert (copy.logits(observation) == policy.logits(observation)).all()
