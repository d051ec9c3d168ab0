"""The choices of a policy: samples of its softmax, or the likeliest choice; they depend only on the observation."""

from __future__ import annotations

import pickle
import sys
from typing import get_args

import numpy as np
import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st
from rsl_rl.utils import resolve_nn_activation
from tensordict import TensorDict
from threadpoolctl import threadpool_info

from tests.runtime.policies.examples import card_of, observation_of, policy_of
from tltl_runtime.policies.actor import ACTIVATIONS, Actor, weight_shapes
from tltl_runtime.policies.blas_threads import blas_threads
from tltl_runtime.policies.network import Activation, Network
from tltl_runtime.policies.policy import Policy
from tltl_runtime.policies.torch_actor import arrays, new_actor, torch_actor
from tltlc.core.record import replace

EXAMPLE = card_of()


@pytest.fixture(name="policy", scope="module", params=[{}, {"map": None}], ids=["map", "no_map"])
def _policy(request: pytest.FixtureRequest) -> Policy:
    return policy_of(card_of("cover_and_hide", sensors=request.param, network=Network()))


def test_the_logits_equal_the_logits_of_rsl_rl(policy: Policy) -> None:
    actor = torch_actor(policy)
    for seed in range(20):
        observation = observation_of(policy.card, np.random.default_rng(seed))
        batch = {key: torch.from_numpy(values).float().unsqueeze(0) for key, values in observation.items()}
        with torch.no_grad():
            action = actor(TensorDict(batch, batch_size=[1]))
            actor(TensorDict(batch, batch_size=[1]), stochastic_output=True)
        logits = torch.from_numpy(policy.logits(observation))
        for part, log in zip(logits.split(policy.card.branches), actor.output_distribution_params, strict=True):
            torch.testing.assert_close(part.log_softmax(-1), log[0], rtol=1e-5, atol=1e-5)
        assert policy.choose(observation).tolist() == action[0].tolist()


@pytest.mark.parametrize("activation", get_args(Activation))
def test_activations_equal_those_of_torch(activation: Activation) -> None:
    sizes = np.concatenate([np.geomspace(1e-6, 120, 200), 20 + np.linspace(-0.01, 0.01, 21), [0, np.inf]])
    values = np.concatenate([-sizes, sizes, [np.nan]]).astype(np.float32)
    with np.errstate(all="ignore"):
        computed = ACTIVATIONS[activation](values)
    expected = resolve_nn_activation(activation)(torch.from_numpy(values)).numpy()
    # Torch's gelu of infinity is NaN.
    compared = np.isfinite(values) if activation == "gelu" else np.full(len(values), True)
    assert computed.dtype == np.float32
    np.testing.assert_allclose(computed[compared], expected[compared], rtol=1e-6, atol=1e-6)


@pytest.mark.hypothesis
@pytest.mark.parametrize("activation", get_args(Activation))
@given(data=st.data())
def test_any_network_computes_what_rsl_rl_computes(activation: Activation, data: st.DataObject) -> None:
    kernel = data.draw(st.integers(1, 6))
    widths = st.lists(st.integers(1, 8), min_size=1, max_size=3).map(tuple)
    network = Network(
        data.draw(widths), activation, data.draw(widths), kernel, data.draw(st.integers(1, min(kernel, 3)))
    )
    shapes: dict[str, tuple[int, ...]] = {"automaton": (data.draw(st.integers(1, 9)),), "progress": (1,)}
    for key in data.draw(st.sampled_from([("map",), ("map", "plan"), ()])):
        shapes[key] = (data.draw(st.integers(1, 4)), data.draw(st.integers(5, 12)), data.draw(st.integers(5, 12)))
    compare_with_rsl_rl(network, shapes, data.draw(st.integers(0, 2**32 - 1)))


def test_the_padding_of_rows_may_differ_from_that_of_columns() -> None:
    compare_with_rsl_rl(Network((4,), "elu", (3,), kernel=3, stride=2), {"progress": (1,), "map": (2, 4, 9)}, 0)


def compare_with_rsl_rl(network: Network, shapes: dict[str, tuple[int, ...]], seed: int) -> None:
    """Compare a network with random weights, and the names and shapes of the weights, with rsl_rl's."""
    card = replace(EXAMPLE, network=network, shapes=tuple(shapes.items()), branches=(3, 2))
    observation = observation_of(card, np.random.default_rng(seed))
    batch = {key: torch.from_numpy(values).float()[None] for key, values in observation.items()}
    try:
        expected_shapes = weight_shapes(network, shapes, card.branches)
    except ValueError:
        with pytest.raises((RuntimeError, ValueError)):
            actor = new_actor(card)
            actor.get_latent(batch)
        return
    actor = new_actor(card)
    torch.manual_seed(seed)
    for weight in actor.state_dict().values():
        weight.uniform_(-1, 1)
    weights = arrays(actor.state_dict())
    assert {name: weight.shape for name, weight in weights.items()} == expected_shapes
    expected = actor.mlp(actor.get_latent(batch))[0].detach().double().numpy()
    logits = Actor(network, shapes, card.branches, weights).logits(observation)
    np.testing.assert_allclose(logits, expected, rtol=1e-4, atol=1e-4 * np.abs(expected).max())


@pytest.mark.parametrize(("kernel", "stride"), [(1, 3), (2, 5), (3, 8)])
def test_a_network_that_rsl_rl_cannot_compute_is_refused(kernel: int, stride: int) -> None:
    network, shapes = Network(kernel=kernel, stride=stride), {"progress": (1,), "map": (1, 7, 7)}
    with pytest.raises(ValueError, match=f"a kernel of {kernel} and a stride of {stride} do not fit a map"):
        weight_shapes(network, shapes, (2,))
    card = replace(EXAMPLE, network=network, shapes=tuple(shapes.items()))
    with pytest.raises((RuntimeError, ValueError)):
        new_actor(card).get_latent({key: torch.zeros(1, *shape) for key, shape in shapes.items()})


@pytest.mark.skipif(sys.platform == "darwin", reason="NumPy may use Accelerate, which threadpoolctl does not know")
def test_numpy_multiplies_in_one_thread() -> None:
    with blas_threads(1):
        pools = [pool["num_threads"] for pool in threadpool_info() if pool["user_api"] == "blas"]
    assert pools and set(pools) == {1}


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
    last = max(name for name in policy.weights() if name.startswith("mlp.")).removesuffix(".weight")
    zeros = {name: weight * (not name.startswith(last)) for name, weight in policy.weights().items()}
    flat = Policy(policy.card, zeros)
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
    again = pickle.loads(pickle.dumps(policy))
    assert again.logits(observation).tobytes() == logits.tobytes()
    assert again.card == policy.card


@pytest.mark.parametrize("activation", get_args(Activation))
def test_a_policy_can_be_pickled_with_any_activation(activation: Activation) -> None:
    policy = policy_of(replace(EXAMPLE, network=replace(EXAMPLE.network, activation=activation)))
    observation = observation_of(policy.card, np.random.default_rng(3))
    again = pickle.loads(pickle.dumps(policy))
    assert again.logits(observation).tobytes() == policy.logits(observation).tobytes()


def test_the_memory_layout_of_weights_does_not_count() -> None:
    policy = policy_of(card_of("cover_and_hide", network=Network()))
    weights = {name: np.asfortranarray(weight, np.float32) for name, weight in policy.weights().items()}
    copy = Policy(policy.card, weights)
    for seed in range(20):
        observation = observation_of(policy.card, np.random.default_rng(seed))
        assert (copy.logits(observation) == policy.logits(observation)).all()
