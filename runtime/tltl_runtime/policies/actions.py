"""The probability distribution of a policy's actions if these have several discrete branches."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import torch
from rsl_rl.modules.distribution import Distribution
from torch import Tensor, nn


class MultiCategorical(Distribution):
    """Independent categorical distributions, one per branch of a ``MultiDiscrete(branches)`` space.

    The policy's network outputs ``sum(branches)`` logits, the first branch first. An action is a
    row of ``len(branches)`` numbers, one choice per branch, stored as floats like all actions in
    rsl-rl. Log probabilities, entropies and divergences are sums over the branches, in nats.

    Raises:
        ValueError: the number of branches is not ``output_dim``, or a branch has no choice.
    """

    def __init__(self, output_dim: int, branches: Sequence[int]) -> None:
        super().__init__(output_dim)
        if len(branches) != output_dim or min(branches, default=0) < 1:
            raise ValueError(f"{output_dim} branches of at least one choice are needed, not {list(branches)}")
        self.branches = tuple(branches)
        self._logs: tuple[Tensor, ...] = ()
        """The log probabilities, one tensor [..., choices] per branch."""

    @property
    def input_dim(self) -> int:
        """The number of logits that the network must output for an action."""
        return sum(self.branches)

    def update(self, mlp_output: Tensor) -> None:
        """Set the distribution from the logits of all branches, ``mlp_output`` [..., sum(branches)]."""
        self._logs = tuple(part.log_softmax(-1) for part in mlp_output.split(self.branches, dim=-1))

    def sample(self) -> Tensor:
        """Return a sampled choice for each branch [..., branches].

        The sample is the argmax of p / E, where p are the probabilities of the choices, and each
        choice has its own E ~ Exp(1) (an exponential race).
        """
        return _argmax([log.exp() / torch.empty_like(log).exponential_() for log in self._logs])

    def deterministic_output(self, mlp_output: Tensor) -> Tensor:
        """Return the likeliest choice of each branch [..., branches]; the first one on ties."""
        return _argmax(mlp_output.split(self.branches, dim=-1))

    def as_deterministic_output_module(self) -> nn.Module:
        """Return a module that maps logits to the likeliest choices."""
        return _LikeliestChoice(self.branches)

    @property
    def mean(self) -> Tensor:
        """The likeliest choice of each branch, because a categorical distribution has no mean."""
        return _argmax([*self._logs])

    @property
    def std(self) -> Tensor:
        """The entropy of each branch [..., branches], in place of a standard deviation.

        A categorical distribution has no standard deviation. rsl-rl only reports this value.
        """
        return torch.stack([_entropy(log) for log in self._logs], -1)

    @property
    def entropy(self) -> Tensor:
        """The sum of the entropies of the branches [...], in nats."""
        return self.std.sum(-1)

    @property
    def params(self) -> tuple[Tensor, ...]:
        """The log probabilities, one tensor [..., choices] per branch."""
        return self._logs

    def log_prob(self, outputs: Tensor) -> Tensor:
        """Return the log probability of actions [..., branches]."""
        choices = outputs.long().unsqueeze(-1).unbind(-2)
        return torch.stack(
            [log.gather(-1, choice).squeeze(-1) for log, choice in zip(self._logs, choices, strict=True)]
        ).sum(0)

    def kl_divergence(self, old_params: tuple[Tensor, ...], new_params: tuple[Tensor, ...]) -> Tensor:
        """Return the divergence KL(old || new) [...] of two values of ``params``."""
        pairs = zip(old_params, new_params, strict=True)
        return torch.stack([(old.exp() * (old - new)).sum(-1) for old, new in pairs]).sum(0)

    def init_mlp_weights(self, mlp: Any) -> None:
        """Set the weights of the last layer so that all choices begin nearly equally likely.

        Then an untrained policy tries every choice.
        """
        last = [layer for layer in mlp if isinstance(layer, nn.Linear)][-1]
        nn.init.orthogonal_(last.weight, gain=0.01)
        nn.init.zeros_(last.bias)


class _LikeliestChoice(nn.Module):
    def __init__(self, branches: tuple[int, ...]) -> None:
        super().__init__()
        self.branches = branches

    def forward(self, logits: Tensor) -> Tensor:
        return _argmax(logits.split(self.branches, dim=-1))


def _argmax(branches: list[Tensor]) -> Tensor:
    """Return the argmax of each branch as [..., branches], in the dtype of the inputs; on ties, the first.

    ``branches`` has a tensor [..., choices] per branch.
    """
    # A list, not a sequence: rsl-rl may export an actor to TorchScript, which has no sequences.
    return torch.stack([values.argmax(-1) for values in branches], -1).to(branches[0].dtype)


def _entropy(log: Tensor) -> Tensor:
    return -(log.exp() * log).sum(-1)
