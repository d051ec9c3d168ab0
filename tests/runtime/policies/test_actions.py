"""The distribution over actions equals one categorical distribution of torch per branch."""

from __future__ import annotations

import numpy as np
import pytest
import torch
from hypothesis import given, settings
from hypothesis import strategies as st
from rsl_rl.modules import MLP
from torch import Tensor
from torch.distributions import Categorical, kl_divergence

from tltl_runtime.policies.actions import MultiCategorical

BRANCHES = st.lists(st.integers(1, 5), min_size=1, max_size=5)
SEEDS = st.integers(0, 2**32 - 1)
SHAPES = st.sampled_from(((), (1,), (6,), (4, 3)))


def logits_of(branches: list[int], shape: tuple[int, ...], seed: int) -> Tensor:
    generator = torch.Generator().manual_seed(seed)
    return 3.0 * torch.randn(*shape, sum(branches), generator=generator, dtype=torch.float64)


def updated(branches: list[int], logits: Tensor) -> MultiCategorical:
    distribution = MultiCategorical(len(branches), branches)
    distribution.update(logits)
    return distribution


def reference(branches: list[int], logits: Tensor) -> list[Categorical]:
    return [Categorical(logits=part) for part in logits.split(branches, dim=-1)]


@settings(max_examples=60, deadline=None)
@given(branches=BRANCHES, shape=SHAPES, seed=SEEDS)
def test_probabilities_entropies_and_divergences_are_those_of_torch(
    branches: list[int], shape: tuple[int, ...], seed: int
) -> None:
    logits, other_logits = logits_of(branches, shape, seed), logits_of(branches, shape, seed ^ 1)
    distribution, other_distribution = updated(branches, logits), updated(branches, other_logits)
    torch.manual_seed(seed)
    actions = distribution.sample()
    assert actions.shape == (*shape, len(branches))
    assert bool(((actions >= 0) & (actions < torch.tensor(branches))).all())
    torch.testing.assert_close(
        distribution.log_prob(actions),
        sum(
            part.log_prob(action) for part, action in zip(reference(branches, logits), actions.unbind(-1), strict=True)
        ),
    )
    entropies = [part.entropy() for part in reference(branches, logits)]
    torch.testing.assert_close(distribution.entropy, sum(entropies))
    torch.testing.assert_close(distribution.std, torch.stack(entropies, -1))
    pairs = zip(reference(branches, logits), reference(branches, other_logits), strict=True)
    torch.testing.assert_close(
        distribution.kl_divergence(distribution.params, other_distribution.params),
        sum(kl_divergence(first, second) for first, second in pairs),
    )
    assert bool((distribution.kl_divergence(distribution.params, distribution.params) == 0.0).all())


@settings(max_examples=30, deadline=None)
@given(branches=BRANCHES, seed=SEEDS)
def test_gradients_are_those_of_torch(branches: list[int], seed: int) -> None:
    ours, theirs = (logits_of(branches, (5,), seed).requires_grad_() for _ in range(2))
    distribution, parts = updated(branches, ours), reference(branches, theirs)
    torch.manual_seed(seed)
    actions = distribution.sample()
    (distribution.log_prob(actions) + 0.5 * distribution.entropy).sum().backward()  # type: ignore[no-untyped-call]
    pairs = zip(parts, actions.unbind(-1), strict=True)
    sum((part.log_prob(action) + 0.5 * part.entropy()).sum() for part, action in pairs).backward()  # type: ignore[union-attr]
    torch.testing.assert_close(ours.grad, theirs.grad)


def test_gradients_of_nearly_impossible_choices_are_finite() -> None:
    logits = torch.tensor([[200.0, -200.0, 0.0, -1000.0]], requires_grad=True)
    distribution = updated([2, 2], logits)
    (distribution.log_prob(torch.zeros(1, 2)) + distribution.entropy).sum().backward()  # type: ignore[no-untyped-call]
    assert logits.grad is not None and bool(logits.grad.isfinite().all())


def test_samples_have_the_expected_frequencies() -> None:
    branches, count = [3, 3, 2, 2, 2], 200_000
    logits = logits_of(branches, (), 5).float()
    torch.manual_seed(7)
    samples = updated(branches, logits.expand(count, -1)).sample().numpy().astype(np.int64)
    for column, part in enumerate(reference(branches, logits)):
        frequencies = np.bincount(samples[:, column], minlength=branches[column]) / count
        expected = part.probs.numpy()
        # Within five standard deviations of a share.
        assert (abs(frequencies - expected) <= 5 * np.sqrt(expected * (1 - expected) / count) + 1e-9).all()
    # Branches are independent; check the first two.
    table = np.zeros((3, 3))
    np.add.at(table, (samples[:, 0], samples[:, 1]), 1 / count)
    assert abs(table - np.outer(table.sum(1), table.sum(0))).max() < 0.005


def test_the_likeliest_choice_is_the_first_of_equal_ones() -> None:
    logits = torch.tensor([[1.0, 2.0, 2.0, 0.0, 0.0, 3.0, 1.0]])
    distribution = updated([3, 2, 2], logits)
    expected = [[1.0, 0.0, 0.0]]
    assert distribution.deterministic_output(logits).tolist() == expected
    assert distribution.as_deterministic_output_module()(logits).tolist() == expected
    assert distribution.mean.tolist() == expected


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_the_likeliest_choice_can_be_exported_to_torchscript() -> None:
    logits = logits_of([3, 2, 2], (4,), 1)
    distribution = MultiCategorical(3, [3, 2, 2])
    exported = torch.jit.script(distribution.as_deterministic_output_module())
    assert torch.equal(exported(logits), distribution.deterministic_output(logits))


def test_a_new_network_is_nearly_uniform() -> None:
    torch.manual_seed(0)
    mlp = MLP(10, 12, [32], "elu")
    distribution = MultiCategorical(5, (3, 3, 2, 2, 2))
    distribution.init_mlp_weights(mlp)
    distribution.update(mlp(torch.randn(100, 10)))
    assert min(log.detach().exp().min().item() for log in distribution.params) > 0.3


@pytest.mark.parametrize("branches", [[3, 3], [3, 3, 0], []])
def test_invalid_branches_are_rejected(branches: list[int]) -> None:
    with pytest.raises(ValueError, match="3 branches of at least one choice"):
        MultiCategorical(3, branches)
