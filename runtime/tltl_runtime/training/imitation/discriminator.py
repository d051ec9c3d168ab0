"""The discriminator of GAIL, which tells decisions of demonstrations from decisions of an agent."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import torch
from rsl_rl.utils import resolve_class
from torch import Tensor, nn
from torch.nn.functional import one_hot, softplus

from tltlc.api import record

Decisions = tuple[Mapping[str, Tensor], Tensor]
"""Observations by key, each [n, ...], and actions [n, branches]."""


@record
class Judged:
    """The ``loss`` of a discriminator, and its mean predicted probabilities of being demonstrated.

    ``theirs`` is the mean over decisions of demonstrations, ``agents`` the mean over the agent's.
    """

    loss: Tensor
    theirs: float
    agents: float


class Discriminator(nn.Module):
    """Predicts the logit of a decision being from a demonstration.

    Ho and Ermon, Generative adversarial imitation learning, NIPS 2016.  ``config`` is rsl-rl's
    configuration of a model.  The network's inputs are observations (``observations`` is an
    example) and actions, one-hot by ``branches``.
    """

    def __init__(self, observations: Mapping[str, Tensor], branches: Sequence[int], config: Mapping[str, Any]) -> None:
        super().__init__()
        self._branches = tuple(branches)
        self._keys = tuple(observations.keys())
        count = next(iter(observations.values())).shape[0]
        joined = self._joined((observations, torch.zeros(count, len(self._branches))))
        model, options = resolve_class(dict(config))
        self.network = model(joined, {"discriminator": [*joined]}, "discriminator", 1, **options)

    def forward(self, decisions: Decisions) -> Tensor:
        """Return the logits [n]."""
        logits: Tensor = self.network(self._joined(decisions)).squeeze(-1)
        return logits

    def reward(self, decisions: Decisions) -> Tensor:
        """Return the rewards [n]: ``-log(1 - D)``, which is at least 0.

        D is the predicted probability of being demonstrated.
        """
        return softplus(self(decisions))

    def judged(self, theirs: Decisions, agents: Decisions, penalty: float) -> Judged:
        """Return the loss: the cross entropy, plus ``penalty`` times the gradient penalty.

        ``theirs`` and ``agents`` are equally many decisions of demonstrations and of an agent.
        """
        demonstrated, played = self(theirs), self(agents)
        loss = softplus(-demonstrated).mean() + softplus(played).mean()
        if penalty:
            loss = loss + penalty * self._gradient_penalty(theirs, agents)
        means = (logits.detach().sigmoid().mean().item() for logits in (demonstrated, played))
        return Judged(loss, *means)

    def _gradient_penalty(self, theirs: Decisions, agents: Decisions) -> Tensor:
        """Return the mean squared deviation from 1 of the gradient's norm, between the two sets.

        Gulrajani et al., Improved training of Wasserstein GANs, NIPS 2017; ML-Agents uses it, too.
        """
        one, other = self._joined(theirs), self._joined(agents)
        share = torch.rand(theirs[1].shape[0], device=theirs[1].device)
        mixed = {
            key: torch.lerp(one[key], other[key], share.view(-1, *[1] * (one[key].dim() - 1))).requires_grad_()
            for key in one
        }
        gradients = torch.autograd.grad(self.network(mixed).sum(), [*mixed.values()], create_graph=True)
        squares = torch.stack([gradient.flatten(1).square().sum(1) for gradient in gradients]).sum(0)
        # The square root is not differentiable at 0.
        norms = (squares + 1e-12).sqrt()
        return (norms - 1.0).square().mean()

    def _joined(self, decisions: Decisions) -> dict[str, Tensor]:
        """Return the observations by key, with the one-hot actions as another input."""
        observations, actions = decisions
        one_hots = [one_hot(branch.long(), count) for branch, count in zip(actions.T, self._branches, strict=True)]
        joined = {key: observations[key] for key in self._keys}
        return {**joined, "action": torch.cat(one_hots, dim=-1).to(torch.float32)}
