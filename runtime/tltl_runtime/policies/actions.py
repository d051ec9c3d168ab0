"""The distribution over actions of several branches, each one of a few."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import torch
from rsl_rl.modules.distribution import Distribution
from torch import Tensor, nn


class MultiCategorical(Distribution):
    """Independent categorical distributions, one a branch: Gymnasium's ``MultiDiscrete(branches)``.

    The network gives ``sum(branches)`` logits, those of the first branch first.  An action is a row of
    ``len(branches)`` numbers, the choice of each branch, held as floats as all actions of rsl-rl are.  Logarithms of
    probabilities, entropies and divergences are sums over the branches, in nats.

    Raises:
        ValueError: there are not as many branches as the environment's actions have, or one has no choice.
    """

    def __init__(self, output_dim: int, branches: Sequence[int]) -> None:
        super().__init__(output_dim)
        if len(branches) != output_dim or min(branches, default=0) < 1:
            raise ValueError(f"{output_dim} branches of at least one choice are needed, not {list(branches)}")
        self.branches = tuple(branches)
        self._logs: tuple[Tensor, ...] = ()
        """The logarithms of the probabilities, a tensor [..., choices] a branch."""

    @property
    def input_dim(self) -> int:
        """How many logits the network gives."""
        return sum(self.branches)

    def update(self, mlp_output: Tensor) -> None:
        """Take the logits [..., sum(branches)]."""
        self._logs = tuple(part.log_softmax(-1) for part in mlp_output.split(self.branches, dim=-1))

    def sample(self) -> Tensor:
        """A choice of each branch [..., branches], by a race of exponential clocks: the first to ring is chosen."""
        return _greatest([log.exp() / torch.empty_like(log).exponential_() for log in self._logs])

    def deterministic_output(self, mlp_output: Tensor) -> Tensor:
        """The likeliest choice of each branch [..., branches]; of equal ones the first."""
        return _greatest(mlp_output.split(self.branches, dim=-1))

    def as_deterministic_output_module(self) -> nn.Module:
        """A module that makes the likeliest choices of logits."""
        return _Likeliest(self.branches)

    @property
    def mean(self) -> Tensor:
        """The likeliest choice of each branch: choices have no mean."""
        return _greatest([*self._logs])

    @property
    def std(self) -> Tensor:
        """The entropy of each branch [..., branches]: choices have no deviation, and rsl-rl but reports this."""
        return torch.stack([_entropy(log) for log in self._logs], -1)

    @property
    def entropy(self) -> Tensor:
        """The entropy [...]."""
        return self.std.sum(-1)

    @property
    def params(self) -> tuple[Tensor, ...]:
        """The logarithms of the probabilities [..., choices], a tensor a branch."""
        return self._logs

    def log_prob(self, outputs: Tensor) -> Tensor:
        """The logarithm of the probability of actions [..., branches]."""
        chosen = outputs.long().unsqueeze(-1).unbind(-2)
        return torch.stack(
            [log.gather(-1, each).squeeze(-1) for log, each in zip(self._logs, chosen, strict=True)]
        ).sum(0)

    def kl_divergence(self, old_params: tuple[Tensor, ...], new_params: tuple[Tensor, ...]) -> Tensor:
        """KL(old || new) [...] of two sets of ``params``."""
        pairs = zip(old_params, new_params, strict=True)
        return torch.stack([(old.exp() * (old - new)).sum(-1) for old, new in pairs]).sum(0)

    def init_mlp_weights(self, mlp: Any) -> None:
        """Begin with choices that are nearly equally likely, so that nothing is ruled out before it was tried."""
        last = [layer for layer in mlp if isinstance(layer, nn.Linear)][-1]
        nn.init.orthogonal_(last.weight, gain=0.01)
        nn.init.zeros_(last.bias)


class _Likeliest(nn.Module):
    def __init__(self, branches: tuple[int, ...]) -> None:
        super().__init__()
        self.branches = branches

    def forward(self, logits: Tensor) -> Tensor:
        return _greatest(logits.split(self.branches, dim=-1))


def _greatest(branches: list[Tensor]) -> Tensor:
    """The place of the greatest value of each branch [..., branches], in their type; of equal ones the first."""
    # TorchScript, to which rsl-rl may export an actor, knows lists and no sequences.
    return torch.stack([values.argmax(-1) for values in branches], -1).to(branches[0].dtype)


def _entropy(log: Tensor) -> Tensor:
    return -(log.exp() * log).sum(-1)
