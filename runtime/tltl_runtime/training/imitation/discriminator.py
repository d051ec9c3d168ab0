"""The discriminator of GAIL: it predicts whether a decision is from a demonstration or from the agent."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import torch
from rsl_rl.utils import resolve_class
from torch import Tensor, nn
from torch.nn.functional import one_hot, softplus

from tltlc.api import record

Decisions = tuple[Mapping[str, Tensor], Tensor]
"""n decisions: observations by key, each [n, ...], and actions [n, width], a row for each decision."""


@record
class DiscriminatorLoss:
    """The ``loss`` of a discriminator on a batch, and how well it tells decisions apart.

    The discriminator predicts the probability that a decision is from a demonstration.
    ``demonstration_probability`` is the mean of this probability over decisions of demonstrations,
    ``agent_probability`` its mean over decisions of the agent. Both are in [0, 1].
    """

    loss: Tensor
    demonstration_probability: float
    agent_probability: float


class Discriminator(nn.Module):
    """A network that predicts, as a logit, whether a decision is from a demonstration.

    Its inputs are the observation and the action, whose choices become one-hot vectors. ``config``
    is rsl-rl's configuration of the network. ``observations`` is an example of a batch. An action
    has several discrete branches; ``branches`` has the number of choices of each. Source: Ho and
    Ermon, Generative adversarial imitation learning, NIPS 2016.
    """

    def __init__(self, observations: Mapping[str, Tensor], branches: Sequence[int], config: Mapping[str, Any]) -> None:
        super().__init__()
        self._branches = tuple(branches)
        self._keys = tuple(observations.keys())
        count = next(iter(observations.values())).shape[0]
        inputs = self._inputs((observations, torch.zeros(count, len(self._branches))))
        model, options = resolve_class(dict(config))
        self.network = model(inputs, {"discriminator": [*inputs]}, "discriminator", 1, **options)

    def forward(self, decisions: Decisions) -> Tensor:
        """Return the logits [n] of the probabilities that decisions are from demonstrations."""
        return self._logits(self._inputs(decisions))

    def reward(self, decisions: Decisions) -> Tensor:
        """Return the rewards [n] of these decisions: ``-log(1 - D)``, which is at least 0.

        D is the predicted probability that a decision is from a demonstration.
        """
        return softplus(self(decisions))

    def loss(self, demonstrations: Decisions, agent: Decisions, penalty: float) -> DiscriminatorLoss:
        """Return the loss: the cross entropy, plus ``penalty`` times the gradient penalty.

        ``demonstrations`` are decisions of demonstrations, and ``agent`` is an equal number of
        decisions of the agent.
        """
        demonstration_logits, agent_logits = self(demonstrations), self(agent)
        loss = softplus(-demonstration_logits).mean() + softplus(agent_logits).mean()
        if penalty:
            loss = loss + penalty * self._gradient_penalty(demonstrations, agent)
        means = (logits.detach().sigmoid().mean().item() for logits in (demonstration_logits, agent_logits))
        return DiscriminatorLoss(loss, *means)

    def _gradient_penalty(self, demonstrations: Decisions, agent: Decisions) -> Tensor:
        """Return the mean of (|gradient| - 1)² at random points between demonstrations and agent.

        Each point is a random mixture of a demonstrated decision and a decision of the agent. The
        gradient is that of the logit with respect to the network's inputs. Source: Gulrajani et
        al., Improved training of Wasserstein GANs, NIPS 2017; ML-Agents uses it, too.
        """
        first, second = self._inputs(demonstrations), self._inputs(agent)
        share = torch.rand(demonstrations[1].shape[0], device=demonstrations[1].device)
        mixed = {
            key: torch.lerp(first[key], second[key], share.view(-1, *[1] * (first[key].dim() - 1))).requires_grad_()
            for key in first
        }
        gradients = torch.autograd.grad(self._logits(mixed).sum(), [*mixed.values()], create_graph=True)
        squares = torch.stack([gradient.flatten(1).square().sum(1) for gradient in gradients]).sum(0)
        # The square root is not differentiable at 0.
        norms = (squares + 1e-12).sqrt()
        return (norms - 1.0).square().mean()

    def update_normalization(self, decisions: Decisions) -> None:
        """Do nothing: this network scales no inputs.

        A subclass may use the agent's ``decisions`` to update the running mean and deviation of its
        inputs.
        """

    def _logits(self, inputs: Mapping[str, Tensor]) -> Tensor:
        """Return the logits [n] for the network's inputs."""
        logits: Tensor = self.network(inputs).squeeze(-1)
        return logits

    def _inputs(self, decisions: Decisions) -> dict[str, Tensor]:
        """Return the network's inputs by key. The key ``action`` has the one-hot actions."""
        observations, actions = decisions
        one_hots = [one_hot(branch.long(), count) for branch, count in zip(actions.T, self._branches, strict=True)]
        inputs = {key: observations[key] for key in self._keys}
        return {**inputs, "action": torch.cat(one_hots, dim=-1).to(torch.float32)}
