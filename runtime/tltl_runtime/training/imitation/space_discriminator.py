"""The discriminator of GAIL for observation and action spaces of any kind."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import torch
from torch import Tensor, nn
from torch.nn.functional import one_hot

from tltl_runtime.policies.network import Network
from tltl_runtime.policies.spaces.layouts import SpaceLayouts
from tltl_runtime.policies.spaces.observation_layout import ObservationPart
from tltl_runtime.policies.spaces.torch_model import SpaceModel
from tltl_runtime.training.imitation.discriminator import Decisions, Discriminator
from tltlc.api import replace

_ACTION: Final = "~action"
"""The key of the action among the network's inputs.

No part of an observation has this key, because a tilde in a key is escaped.
"""


class SpaceDiscriminator(Discriminator):
    """A discriminator that encodes observations as the policy's network for ``layouts`` does.

    The action is one more input: its choices as one-hot vectors, and its continuous numbers. A
    number with two bounds is squashed to [-1, 1] first. The gradient penalty is computed at
    mixtures of encoded inputs: one-hot vectors, planes of images, and scaled numbers.
    """

    network: SpaceModel

    def __init__(self, layouts: SpaceLayouts, network: Network) -> None:
        nn.Module.__init__(self)
        self._action = layouts.action
        width = layouts.action.output_width
        bounded = [low is not None and high is not None for low, high in layouts.action.bounds]
        is_bounded = [True] * sum(layouts.action.sizes) + bounded
        low, high = (tuple(bound if one else None for one in is_bounded) for bound in (-1.0, 1.0))
        part = ObservationPart(_ACTION, (_ACTION,), "numbers", (width,), low=low, high=high)
        inputs = replace(layouts, observation=(*layouts.observation, part))
        groups = {"discriminator": [part.key for part in inputs.observation]}
        self.network = SpaceModel({}, groups, "discriminator", 1, network, inputs)
        self._is_bounded = bounded

    def update_normalization(self, decisions: Decisions) -> None:
        """Update the running mean and deviation of inputs without bounds from the agent's decisions."""
        self.network.update_normalization(self._observed(decisions))

    def _inputs(self, decisions: Decisions) -> dict[str, Tensor]:
        return self.network.inputs(self._observed(decisions))

    def _logits(self, inputs: Mapping[str, Tensor]) -> Tensor:
        logits: Tensor = self.network.mlp(self.network.encoded(inputs)).squeeze(-1)
        return logits

    def _observed(self, decisions: Decisions) -> dict[str, Tensor]:
        """Return the observations by key, and under the key ``_ACTION`` the actions as vectors of numbers."""
        observations, actions = decisions
        sizes = self._action.sizes
        choices, numbers = actions.split([len(sizes), self._action.number_count], dim=-1)
        parts = [one_hot(choice.long(), size).float() for choice, size in zip(choices.T, sizes, strict=True)]
        columns = numbers.unbind(-1) if self._action.number_count else ()
        parts += [
            (column.tanh() if bounded else column).unsqueeze(-1)
            for column, bounded in zip(columns, self._is_bounded, strict=True)
        ]
        observed = {key: observations[key] for key in observations.keys()}  # noqa: SIM118  (a TensorDict)
        return {**observed, _ACTION: torch.cat(parts, dim=-1)}
