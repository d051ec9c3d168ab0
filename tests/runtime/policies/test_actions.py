"""The distribution over actions is torch's own, branch by branch."""

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
def test_probabilities_entropies_and_divergences(branches: list[int], shape: tuple[int, ...], seed: int) -> None:
    logits, others = logits_of(branches, shape, seed), logits_of(branches, shape, seed ^ 1)
    one, other = updated(branches, logits), updated(branches, others)
    torch.manual_seed(seed)
    actions = one.sample()
    assert actions.shape == (*shape, len(branches))
    assert bool(((actions >= 0) & (actions < torch.tensor(branches))).all())
    torch.testing.assert_close(
        one.log_prob(actions),
        sum(
            each.log_prob(action) for each, action in zip(reference(branches, logits), actions.unbind(-1), strict=True)
        ),
    )
    entropies = [each.entropy() for each in reference(branches, logits)]
    torch.testing.assert_close(one.entropy, sum(entropies))
    torch.testing.assert_close(one.std, torch.stack(entropies, -1))
    pairs = zip(reference(branches, logits), reference(branches, others), strict=True)
    torch.testing.assert_close(
        one.kl_divergence(one.params, other.params), sum(kl_divergence(first, second) for first, second in pairs)
    )
    assert bool((one.kl_divergence(one.params, one.params) == 0.0).all())


@settings(max_examples=30, deadline=None)
@given(branches=BRANCHES, seed=SEEDS)
def test_gradients(branches: list[int], seed: int) -> None:
    ours, theirs = (logits_of(branches, (5,), seed).requires_grad_() for _ in range(2))
    one, parts = updated(branches, ours), reference(branches, theirs)
    torch.manual_seed(seed)
    actions = one.sample()
    (one.log_prob(actions) + 0.5 * one.entropy).sum().backward()  # type: ignore[no-untyped-call]
    each = zip(parts, actions.unbind(-1), strict=True)
    sum((part.log_prob(action) + 0.5 * part.entropy()).sum() for part, action in each).backward()  # type: ignore[union-attr]
    torch.testing.assert_close(ours.grad, theirs.grad)


def test_gradients_of_choices_that_are_next_to_impossible_are_numbers() -> None:
    logits = torch.tensor([[200.0, -200.0, 0.0, -1000.0]], requires_grad=True)
    one = updated([2, 2], logits)
    (one.log_prob(torch.zeros(1, 2)) + one.entropy).sum().backward()  # type: ignore[no-untyped-call]
    assert logits.grad is not None and bool(logits.grad.isfinite().all())


def test_samples_have_their_frequencies() -> None:
    branches, count = [3, 3, 2, 2, 2], 200_000
    logits = logits_of(branches, (), 5).float()
    torch.manual_seed(7)
    samples = updated(branches, logits.expand(count, -1)).sample().numpy().astype(np.int64)
    for column, part in enumerate(reference(branches, logits)):
        found = np.bincount(samples[:, column], minlength=branches[column]) / count
        expected = part.probs.numpy()
        # Five deviations of a share.
        assert (abs(found - expected) <= 5 * np.sqrt(expected * (1 - expected) / count) + 1e-9).all()
    # Branches are independent of each other: so are the first two.
    table = np.zeros((3, 3))
    np.add.at(table, (samples[:, 0], samples[:, 1]), 1 / count)
    assert abs(table - np.outer(table.sum(1), table.sum(0))).max() < 0.005


def test_the_likeliest_choice_is_the_first_of_equal_ones() -> None:
    logits = torch.tensor([[1.0, 2.0, 2.0, 0.0, 0.0, 3.0, 1.0]])
    one = updated([3, 2, 2], logits)
    wanted = [[1.0, 0.0, 0.0]]
    assert one.deterministic_output(logits).tolist() == wanted
    assert one.as_deterministic_output_module()(logits).tolist() == wanted
    assert one.mean.tolist() == wanted


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_the_likeliest_choice_can_be_exported_to_torchscript() -> None:
    logits = logits_of([3, 2, 2], (4,), 1)
    one = MultiCategorical(3, [3, 2, 2])
    exported = torch.jit.script(one.as_deterministic_output_module())
    assert torch.equal(exported(logits), one.deterministic_output(logits))


def test_a_new_network_rules_nothing_out() -> None:
    torch.manual_seed(0)
    mlp = MLP(10, 12, [32], "elu")
    one = MultiCategorical(5, (3, 3, 2, 2, 2))
    one.init_mlp_weights(mlp)
    one.update(mlp(torch.randn(100, 10)))
    assert min(log.detach().exp().min().item() for log in one.params) > 0.3


@pytest.mark.parametrize("branches", [[3, 3], [3, 3, 0], []])
def test_branches_that_do_not_fit(branches: list[int]) -> None:
    with pytest.raises(ValueError, match="3 branches of at least one choice"):
        MultiCategorical(3, branches)
