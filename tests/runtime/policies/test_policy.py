"""What a policy chooses: samples of its softmax, or the likeliest, by the observation alone."""

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


def test_the_logits_are_those_of_the_model_of_rsl_rl(policy: Policy) -> None:
    for seed in range(20):
        seen = observation_of(policy.card, np.random.default_rng(seed))
        batch = {key: torch.from_numpy(each).float().unsqueeze(0) for key, each in seen.items()}
        with torch.no_grad():
            action = policy.actor(TensorDict(batch, batch_size=[1]))
            policy.actor(TensorDict(batch, batch_size=[1]), stochastic_output=True)
        logits = torch.from_numpy(policy.logits(seen).copy())
        for part, log in zip(logits.split(policy.card.branches), policy.actor.output_distribution_params, strict=True):
            torch.testing.assert_close(part.log_softmax(-1), log[0], rtol=0, atol=0)
        assert policy.choose(seen).tolist() == action[0].tolist()


def test_samples_have_the_frequencies_of_the_softmax(policy: Policy) -> None:
    seen, generator, count = observation_of(policy.card, np.random.default_rng(3)), np.random.default_rng(4), 4000
    samples = np.array([policy.choose(seen, generator) for _ in range(count)])
    logits = torch.from_numpy(policy.logits(seen).copy())
    for column, part in enumerate(logits.split(policy.card.branches)):
        expected = part.double().softmax(-1).numpy()
        found = np.bincount(samples[:, column], minlength=len(expected)) / count
        # Five deviations of a share.
        assert (abs(found - expected) <= 5 * np.sqrt(expected * (1 - expected) / count) + 1e-9).all()


def test_equal_generators_give_equal_choices(policy: Policy) -> None:
    seen = observation_of(policy.card, np.random.default_rng(3))
    one, other = ([policy.choose(seen, rng).tolist() for _ in range(50)] for rng in map(np.random.default_rng, (1, 1)))
    assert one == other
    assert len(set(map(tuple, one))) > 1


def test_the_first_of_equal_choices(policy: Policy) -> None:
    with torch.no_grad():
        flat = Policy(policy.card, policy.weights())
        flat.actor.mlp[-1].weight.zero_()
        flat.actor.mlp[-1].bias.zero_()
    seen = observation_of(policy.card, np.random.default_rng(3))
    assert flat.choose(seen).tolist() == [0, 0, 0, 0, 0]
    assert flat.choose(seen).dtype == np.int64


def test_choosing_leaves_no_trace(policy: Policy) -> None:
    """Neither in torch's random numbers, nor in the policy, nor in the observation; and it goes to other processes."""
    seen = observation_of(policy.card, np.random.default_rng(3))
    before = {key: each.copy() for key, each in seen.items()}
    state, logits = torch.get_rng_state(), policy.logits(seen)
    policy.choose(seen, np.random.default_rng(0))
    assert torch.equal(state, torch.get_rng_state())
    assert all((seen[key] == before[key]).all() for key in seen)
    assert (policy.logits(seen) == logits).all()
    assert not any(each.requires_grad for each in policy.actor.parameters())
    again = pickle.loads(pickle.dumps(policy))
    assert again.logits(seen).tobytes() == logits.tobytes()
    assert again.card == policy.card


def test_how_weights_lie_in_memory_does_not_count() -> None:
    policy = policy_of(card_of("cover_and_hide", network=Network()))
    lying = {
        name: each.float().to(memory_format=torch.channels_last) if each.dim() == 4 else each.float()
        for name, each in policy.weights().items()
    }
    other = Policy(policy.card, lying)
    for seed in range(20):
        seen = observation_of(policy.card, np.random.default_rng(seed))
        assert (other.logits(seen) == policy.logits(seen)).all()
