"""What tells the decisions of demonstrations from those of an agent: the discriminator of GAIL."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import torch
from rsl_rl.utils import resolve_class
from torch import Tensor, nn
from torch.nn.functional import one_hot, softplus

from tltlc.core.record import record

Decisions = tuple[Mapping[str, Tensor], Tensor]
"""Observations by key, each [n, ...], and actions [n, branches]."""


@record
class Judged:
    """What a discriminator is to lower, ``loss``, and the mean probabilities that it gives decisions to be of
    demonstrations: those that are, ``theirs``, and the ``agents``.
    """

    loss: Tensor
    theirs: float
    agents: float


class Discriminator(nn.Module):
    """Gives each decision a logit, the greater the likelier it is one of a demonstration.

    The network is that of ``config``, rsl-rl's of a model, over ``observations`` (an example of them) and the actions,
    one-hot by ``branches``.  Ho and Ermon, Generative adversarial imitation learning, NIPS 2016.
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
        """The logits [n]."""
        logits: Tensor = self.network(self._joined(decisions)).squeeze(-1)
        return logits

    def reward(self, decisions: Decisions) -> Tensor:
        """What decisions are worth [n], with D their probability ``-log(1 - D)``, which is never below 0."""
        return softplus(self(decisions))

    def judged(self, theirs: Decisions, agents: Decisions, penalty: float) -> Judged:
        """The cross entropy of as many decisions of demonstrations as of an agent, and the ``penalty`` on gradients."""
        demonstrated, played = self(theirs), self(agents)
        loss = softplus(-demonstrated).mean() + softplus(played).mean()
        if penalty:
            loss = loss + penalty * self._steepness(theirs, agents)
        means = (each.detach().sigmoid().mean().item() for each in (demonstrated, played))
        return Judged(loss, *means)

    def _steepness(self, theirs: Decisions, agents: Decisions) -> Tensor:
        """How far from 1 the gradient's norm is between the two: Gulrajani et al., Improved training of Wasserstein
        GANs, NIPS 2017, which ML-Agents does, too.
        """
        one, other = self._joined(theirs), self._joined(agents)
        share = torch.rand(theirs[1].shape[0], device=theirs[1].device)
        mixed = {
            key: torch.lerp(one[key], other[key], share.view(-1, *[1] * (one[key].dim() - 1))).requires_grad_()
            for key in one
        }
        gradients = torch.autograd.grad(self.network(mixed).sum(), [*mixed.values()], create_graph=True)
        squares = torch.stack([each.flatten(1).square().sum(1) for each in gradients]).sum(0)
        # A root is not differentiable at 0.
        norms = (squares + 1e-12).sqrt()
        return (norms - 1.0).square().mean()

    def _joined(self, decisions: Decisions) -> dict[str, Tensor]:
        """Observations, and the actions beside them."""
        observations, actions = decisions
        chosen = [one_hot(each.long(), choices) for each, choices in zip(actions.T, self._branches, strict=True)]
        joined = {key: observations[key] for key in self._keys}
        return {**joined, "action": torch.cat(chosen, dim=-1).to(torch.float32)}
