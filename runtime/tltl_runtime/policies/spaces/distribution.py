"""The probability distribution of a policy's actions if these have choices, continuous numbers, or both."""

from __future__ import annotations

import math
from typing import Any, Final

import torch
from rsl_rl.modules.distribution import Distribution
from torch import Tensor, nn

from tltl_runtime.policies.actions import MultiCategorical
from tltl_runtime.policies.spaces.action_layout import ActionLayout
from tltl_runtime.policies.spaces.space_actor import LEAST_LOG, MOST_LOG

_LOG_ROOT_OF_TAU: Final = 0.5 * math.log(2 * math.pi)


class IndependentParts(Distribution):
    """Independent distributions: a categorical one for each choice of an action, a normal one for each number.

    An action is a row [..., width]: the choices, and then the continuous numbers before they are
    squashed to their bounds. The network outputs the logits of all choices and the means of all
    numbers. The standard deviations do not depend on the observation: they are weights of their
    own, and ``log_deviation`` has their logarithms. Log probabilities, entropies and divergences
    are sums over all choices and numbers, in nats.

    All densities are those before squashing. Squashing would change them only by a factor that does
    not depend on the weights, so PPO's ratios and divergences are the same with and without it.

    Raises:
        ValueError: ``output_dim`` is not the width of the layout.
    """

    def __init__(self, output_dim: int, layout: ActionLayout) -> None:
        super().__init__(output_dim)
        if output_dim != layout.width:
            raise ValueError(f"an action of this layout has {layout.width} values, not {output_dim}")
        self.layout = layout
        self._sizes, self._numbers = layout.sizes, layout.number_count
        self._choices = MultiCategorical(len(self._sizes), self._sizes) if self._sizes else None
        if self._numbers:
            self.log_deviation = nn.Parameter(torch.zeros(self._numbers))
        self._means = torch.zeros(0)
        self._deviations = torch.zeros(0)

    @property
    def input_dim(self) -> int:
        """The number of outputs of the network: a logit for each choice, a mean for each number."""
        return self.layout.output_width

    def update(self, mlp_output: Tensor) -> None:
        """Set the distribution from outputs of the network [..., input_dim]."""
        logits, self._means = self._split(mlp_output)
        if self._choices:
            self._choices.update(logits)
        if self._numbers:
            self._deviations = self.log_deviation.clamp(LEAST_LOG, MOST_LOG).exp().expand_as(self._means)

    def sample(self) -> Tensor:
        """Return a sampled action [..., width]."""
        numbers = self._means + self._deviations * torch.randn_like(self._means) if self._numbers else None
        return _joined(self._choices and self._choices.sample(), numbers)

    def deterministic_output(self, mlp_output: Tensor) -> Tensor:
        """Return the likeliest action [..., width]: the likeliest choices, and the means of the numbers.

        On ties, the first choice is taken.
        """
        logits, means = self._split(mlp_output)
        return _joined(self._choices and self._choices.deterministic_output(logits), means if self._numbers else None)

    def as_deterministic_output_module(self) -> nn.Module:
        """Return a module that maps outputs of the network to the likeliest choices and the means."""
        return _LikeliestAction(self)

    @property
    def mean(self) -> Tensor:
        """The likeliest choices and the means of the numbers."""
        return _joined(self._choices and self._choices.mean, self._means if self._numbers else None)

    @property
    def std(self) -> Tensor:
        """The entropies of the choices, and the standard deviations of the numbers [..., width].

        Choices have no standard deviation. rsl-rl only reports these values.
        """
        return _joined(self._choices and self._choices.std, self._deviations if self._numbers else None)

    @property
    def entropy(self) -> Tensor:
        """The sum of the entropies of all parts [...], in nats."""
        terms = [self._choices.entropy] if self._choices else []
        if self._numbers:
            terms.append((self._deviations.log() + 0.5 + _LOG_ROOT_OF_TAU).sum(-1))
        return _total(terms)

    @property
    def params(self) -> tuple[Tensor, ...]:
        """The log probabilities, one tensor [..., choices] per choice, then means and deviations of the numbers."""
        choices = self._choices.params if self._choices else ()
        return (*choices, self._means, self._deviations) if self._numbers else choices

    def log_prob(self, outputs: Tensor) -> Tensor:
        """Return the log probability density [...] of actions [..., width], before squashing."""
        choices, numbers = outputs.split([len(self._sizes), self._numbers], dim=-1)
        terms = [self._choices.log_prob(choices)] if self._choices else []
        if self._numbers:
            scaled = (numbers - self._means) / self._deviations
            terms.append(-(scaled.square() / 2 + self._deviations.log() + _LOG_ROOT_OF_TAU).sum(-1))
        return _total(terms)

    def kl_divergence(self, old_params: tuple[Tensor, ...], new_params: tuple[Tensor, ...]) -> Tensor:
        """Return the divergence KL(old || new) [...] of two values of ``params``."""
        count = len(self._sizes)
        terms = [self._choices.kl_divergence(old_params[:count], new_params[:count])] if self._choices else []
        if self._numbers:
            (old_mean, old), (new_mean, new) = old_params[count:], new_params[count:]
            ratio = (old.square() + (old_mean - new_mean).square()) / (2 * new.square())
            terms.append((new.log() - old.log() + ratio - 0.5).sum(-1))
        return _total(terms)

    def init_mlp_weights(self, mlp: Any) -> None:
        """Set the weights of the last layer so that choices begin nearly equally likely, and means near 0."""
        last = [layer for layer in mlp if isinstance(layer, nn.Linear)][-1]
        nn.init.orthogonal_(last.weight, gain=0.01)
        nn.init.zeros_(last.bias)

    def sharpen(self, last: nn.Linear, factor: float) -> None:
        """Raise all probabilities to the power of ``factor``, and normalize them again.

        To do so, multiply the logits of the choices in ``last``, the network's last layer, by
        ``factor``, and divide the variances of the numbers by it.
        """
        logits = sum(self._sizes)
        with torch.no_grad():
            for parameter in last.parameters():
                parameter[:logits].mul_(factor)
            if self._numbers:
                self.log_deviation.sub_(math.log(factor) / 2)

    def _split(self, outputs: Tensor) -> tuple[Tensor, Tensor]:
        logits, means = outputs.split([sum(self._sizes), self._numbers], dim=-1)
        return logits, means


class _LikeliestAction(nn.Module):
    def __init__(self, distribution: IndependentParts) -> None:
        super().__init__()
        self.distribution = distribution

    def forward(self, outputs: Tensor) -> Tensor:
        return self.distribution.deterministic_output(outputs)


def _joined(choices: Tensor | None, numbers: Tensor | None) -> Tensor:
    return torch.cat([part for part in (choices, numbers) if part is not None], -1)


def _total(terms: list[Tensor]) -> Tensor:
    return torch.stack(terms).sum(0)
