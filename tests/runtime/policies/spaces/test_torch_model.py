"""torch computes what NumPy computes, for any spaces; and the distribution is that of torch.distributions."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch
from gymnasium import spaces
from hypothesis import given
from hypothesis import strategies as st
from torch import Tensor, nn
from torch.distributions import Categorical, Normal, kl_divergence

from tests.runtime.policies.spaces.random_spaces import ACTIONS, OBSERVATIONS
from tests.runtime.policies.spaces.space_policies import SMALL, card_of_spaces, policy_of_spaces
from tltl_runtime.policies.spaces.action_layout import ActionLayout, action_layout
from tltl_runtime.policies.spaces.distribution import IndependentParts
from tltl_runtime.policies.spaces.encoder_plan import space_weight_shapes
from tltl_runtime.policies.spaces.layouts import SpaceLayouts, space_layouts
from tltl_runtime.policies.spaces.observation_layout import observation_layout
from tltl_runtime.policies.spaces.torch_model import Normalizer
from tltl_runtime.policies.spaces.values import observation_arrays
from tltl_runtime.policies.torch_actor import new_actor, torch_actor

SEEDS = st.integers(0, 2**31 - 1)
MIXED = spaces.Dict({"go": spaces.Box(-2, 5, (2,), np.float32), "use": spaces.MultiDiscrete([3, 4])})


@pytest.mark.hypothesis
@given(observation=OBSERVATIONS, action=ACTIONS, seed=SEEDS)
def test_torch_computes_what_numpy_computes(
    observation: spaces.Space[Any], action: spaces.Space[Any], seed: int
) -> None:
    if space_layouts(observation, action) is None:
        return
    policy = policy_of_spaces(observation, action, seed)
    layouts = policy.card.spaces
    assert layouts is not None
    observation.seed(seed)
    seen = [observation.sample() for _ in range(2)]
    rows = [observation_arrays(layouts.observation, value) for value in seen]
    tensors = {key: torch.from_numpy(np.stack([row[key] for row in rows])) for key in rows[0]}
    actor = torch_actor(policy)
    outputs = actor.mlp(actor.get_latent(tensors))
    likeliest = actor(tensors)
    for row, value in enumerate(seen):
        expected = policy.logits(value)
        np.testing.assert_allclose(outputs[row].numpy(), expected, rtol=1e-4, atol=1e-4)
        first = len(layouts.action.sizes)
        means = likeliest[row, first:].numpy()
        np.testing.assert_allclose(means, expected[len(expected) - len(means) :], rtol=1e-4, atol=1e-4)


def test_the_weights_of_a_new_actor_have_the_names_and_shapes_of_the_plan() -> None:
    observation = spaces.Dict(
        {"image": spaces.Box(0, 255, (7, 7, 3), np.uint8), "x": spaces.Box(-np.inf, np.inf, (2,), np.float32)}
    )
    card = card_of_spaces(observation, MIXED)
    assert card.spaces is not None
    weights = new_actor(card).state_dict()
    assert {name: tuple(weight.shape) for name, weight in weights.items()} == space_weight_shapes(SMALL, card.spaces)


# --- the distribution -------------------------------------------------------------------------------


def parts_of(layout: ActionLayout, outputs: Tensor, deviations: Tensor) -> tuple[list[Categorical], Normal | None]:
    """Return the same distributions of torch."""
    logits, means = outputs.split([sum(layout.sizes), layout.number_count], dim=-1)
    choices = [Categorical(logits=part) for part in logits.split(list(layout.sizes), dim=-1)] if layout.sizes else []
    return choices, Normal(means, deviations) if layout.number_count else None


@pytest.mark.hypothesis
@given(space=ACTIONS, seed=SEEDS)
def test_probabilities_are_those_of_torch(space: spaces.Space[Any], seed: int) -> None:
    torch.manual_seed(seed)
    layout = action_layout(space)
    distribution = IndependentParts(layout.width, layout)
    pairs = []
    for _ in range(2):
        outputs = torch.randn(5, layout.output_width)
        deviations = torch.ones(layout.number_count)
        if layout.number_count:
            with torch.no_grad():
                distribution.log_deviation.uniform_(-2, 0.9)
            deviations = distribution.log_deviation.detach().exp()
        distribution.update(outputs)
        pairs.append((parts_of(layout, outputs, deviations), tuple(part.detach() for part in distribution.params)))
    (old, new), (old_params, new_params) = zip(*pairs, strict=True)
    choices, numbers = new
    sample = distribution.sample().detach()
    assert sample.shape == (5, layout.width)
    first = len(layout.sizes)
    log_prob = sum((part.log_prob(sample[:, column]) for column, part in enumerate(choices)), torch.zeros(5))
    entropy = sum((part.entropy() for part in choices), torch.zeros(5))
    divergence = sum(
        (kl_divergence(before, after) for before, after in zip(old[0], choices, strict=True)), torch.zeros(5)
    )
    if numbers is not None:
        log_prob += numbers.log_prob(sample[:, first:]).sum(-1)
        entropy += numbers.entropy().sum(-1)
        divergence += kl_divergence(old[1], numbers).sum(-1)
    torch.testing.assert_close(distribution.log_prob(sample), log_prob, rtol=1e-4, atol=1e-4)
    torch.testing.assert_close(distribution.entropy, entropy, rtol=1e-4, atol=1e-4)
    torch.testing.assert_close(distribution.kl_divergence(old_params, new_params), divergence, rtol=1e-4, atol=1e-4)


def test_samples_have_the_probabilities_of_the_distribution() -> None:
    torch.manual_seed(0)
    layout = action_layout(MIXED)
    distribution = IndependentParts(layout.width, layout)
    with torch.no_grad():
        distribution.log_deviation.copy_(torch.tensor([0.5, 2.0]).log())
    outputs = torch.tensor([0.0, 1.0, 2.0, 0.0, 0.0, 0.0, 3.0, -1.0, 4.0])
    distribution.update(outputs.expand(40_000, -1))
    samples = distribution.sample()
    shares = torch.stack([(samples[:, 0] == choice).float().mean() for choice in range(3)])
    torch.testing.assert_close(shares, outputs[:3].softmax(0), rtol=0, atol=0.01)
    torch.testing.assert_close(samples[:, 2:].mean(0), torch.tensor([-1.0, 4.0]), rtol=0, atol=0.05)
    torch.testing.assert_close(samples[:, 2:].std(0), torch.tensor([0.5, 2.0]), rtol=0.02, atol=0)


def test_sharpening_makes_likely_choices_likelier_and_numbers_less_scattered() -> None:
    layout = action_layout(MIXED)
    distribution = IndependentParts(layout.width, layout)
    last = nn.Linear(3, layout.output_width)
    latent = torch.randn(4, 3)
    before = last(latent).detach()
    with torch.no_grad():
        distribution.sharpen(last, 4.0)
    after = last(latent).detach()
    torch.testing.assert_close(after[:, :7], 4 * before[:, :7])
    torch.testing.assert_close(after[:, 7:], before[:, 7:])
    torch.testing.assert_close(distribution.log_deviation.detach().exp(), torch.full((2,), 0.5))


# --- running scales ---------------------------------------------------------------------------------


def test_running_scales_are_those_of_all_batches_together() -> None:
    low, high = np.array([-1.0, -np.inf, -100.0], np.float32), np.array([0.5, np.inf, 100.0], np.float32)
    layouts = SpaceLayouts(observation_layout(spaces.Box(low, high)), action_layout(MIXED))
    normalizer = Normalizer(layouts)
    generator = torch.Generator().manual_seed(0)
    batches = [torch.randn(count, 3, generator=generator) * torch.tensor([1.0, 40.0, 2.0]) + 7 for count in (5, 60, 1)]
    for batch in batches:
        normalizer.update(batch)
    every = torch.cat(batches)
    torch.testing.assert_close(normalizer.mean, torch.cat([torch.tensor([-0.25]), every.mean(0)[1:]]))
    deviation = every.std(0, correction=0)[1:]
    torch.testing.assert_close(normalizer.deviation, torch.cat([torch.tensor([0.75]), deviation]))
    assert normalizer.count.item() == len(every)


def test_a_flag_that_is_rarely_set_does_not_become_huge() -> None:
    layouts = SpaceLayouts(observation_layout(spaces.Box(-10, 10, (1,))), action_layout(MIXED))
    normalizer = Normalizer(layouts)
    normalizer.update(torch.zeros(100, 1))
    assert normalizer(torch.ones(1, 1)).item() == pytest.approx(2.0)


def test_a_scale_that_no_observation_has_changed_can_be_kept() -> None:
    layouts = SpaceLayouts(observation_layout(spaces.Box(-10, 10, (1,))), action_layout(MIXED))
    for batches, deviation in ((0, 10.0), (1, 0.5)):
        normalizer = Normalizer(layouts)
        for _ in range(batches):
            normalizer.update(torch.zeros(8, 1))
        normalizer.freeze_if_unused()
        normalizer.update(torch.zeros(8, 1))
        assert normalizer.deviation.item() == pytest.approx(deviation)


@pytest.mark.slow
def test_processes_scale_by_what_all_of_them_have_seen(tmp_path: Path) -> None:
    torch.multiprocessing.spawn(_update_in_a_process, (tmp_path,), nprocs=2)
    first, second = (torch.load(tmp_path / f"{rank}.pt") for rank in range(2))
    every = torch.arange(12.0)
    for state in (first, second):
        torch.testing.assert_close(state["mean"], every.mean().reshape(1))
        torch.testing.assert_close(state["deviation"], every.std(correction=0).reshape(1))
        assert state["count"].item() == 12


def _update_in_a_process(rank: int, folder: Path) -> None:
    torch.distributed.init_process_group("gloo", init_method=f"file://{folder}/group", rank=rank, world_size=2)
    layouts = SpaceLayouts(observation_layout(spaces.Box(-np.inf, np.inf, (1,))), action_layout(MIXED))
    normalizer = Normalizer(layouts)
    for batch in torch.arange(12.0).reshape(2, 2, 3)[rank]:
        normalizer.update(batch.unsqueeze(-1))
    torch.save(normalizer.state_dict(), folder / f"{rank}.pt")
    torch.distributed.destroy_process_group()
