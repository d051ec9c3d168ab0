"""The network of a policy for spaces of any kind, as a model of rsl-rl."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

import torch
from rsl_rl.models import MLPModel
from rsl_rl.utils import resolve_nn_activation
from torch import Tensor, distributed, nn

from tltl_runtime.policies.network import Network
from tltl_runtime.policies.spaces.encoder_plan import (
    BITS,
    convolutions,
    encoded_width,
    initial_scale,
    least_deviations,
    map_parts,
    number_count,
)
from tltl_runtime.policies.spaces.layouts import SpaceLayouts
from tltl_runtime.policies.spaces.observation_layout import ObservationPart
from tltl_runtime.policies.spaces.space_actor import FARTHEST

_NUMBERS: Final = "~numbers"
"""The key of all numbers together, among the encoded inputs.

No part of an observation has this key, because a tilde in a key is escaped.
"""


class SpaceModel(MLPModel):
    """An actor or critic whose inputs are the parts of an observation that ``layouts`` describe.

    An actor's weights have the names and shapes of
    :func:`~tltl_runtime.policies.spaces.encoder_plan.space_weight_shapes`. The other arguments are
    those of rsl-rl's ``MLPModel``.
    """

    def __init__(
        self,
        obs: Mapping[str, Tensor],
        obs_groups: dict[str, list[str]],
        obs_set: str,
        output_dim: int,
        network: Network,
        layouts: SpaceLayouts,
        distribution_cfg: dict[str, Any] | None = None,
    ) -> None:
        self._network, self._layouts = network, layouts
        super().__init__(
            obs, obs_groups, obs_set, output_dim, list(network.hidden), network.activation, False, distribution_cfg
        )
        self.normalizer = Normalizer(layouts) if number_count(layouts) else None
        self.encoders = nn.ModuleDict({str(index): _encoder(part, network) for index, part in map_parts(layouts)})

    def get_latent(self, obs: Mapping[str, Tensor], masks: Any = None, hidden_state: Any = None) -> Tensor:
        """Encode observations: return the inputs [batch, width] of the fully connected layers."""
        return self.encoded(self.inputs(obs))

    def inputs(self, obs: Mapping[str, Tensor]) -> dict[str, Tensor]:
        """Return the inputs of the encoders, by key, as floats [batch, ...].

        They are scaled numbers, one-hot vectors of categories, and planes of images and grids.
        """
        parts = self._layouts.observation
        inputs = {} if self.normalizer is None else {_NUMBERS: self.normalizer(_numbers(parts, obs))}
        inputs |= {part.key: _one_hot(part, obs[part.key]) for part in parts if part.kind == "categories"}
        return inputs | {part.key: _planes(part, obs[part.key]) for _, part in map_parts(self._layouts)}

    def encoded(self, inputs: Mapping[str, Tensor]) -> Tensor:
        """Encode the result of :meth:`inputs`: return the inputs [batch, width] of the fully connected layers."""
        encoders = {part.key: self.encoders[str(index)] for index, part in map_parts(self._layouts)}
        return torch.cat(
            [encoders[key](values).flatten(1) if key in encoders else values for key, values in inputs.items()], -1
        )

    def update_normalization(self, obs: Mapping[str, Tensor]) -> None:
        """Update the running mean and deviation of numbers without bounds from a batch of observations.

        With several processes, all must call this method; the batches of all are used.
        """
        if self.normalizer is not None:
            self.normalizer.update(_numbers(self._layouts.observation, obs))

    def _get_obs_dim(
        self, obs: Mapping[str, Tensor], obs_groups: dict[str, list[str]], obs_set: str
    ) -> tuple[list[str], int]:
        return obs_groups[obs_set], encoded_width(self._layouts, self._network)


class Normalizer(nn.Module):
    """Scales the numbers of observations [batch, numbers].

    A number with bounds within [-1, 1] is scaled to [-1, 1] by them, any other number by a running mean
    and deviation. A running deviation has a least value, see
    :func:`~tltl_runtime.policies.spaces.encoder_plan.least_deviations`: otherwise a number that has
    hardly changed so far would become huge as soon as it changes. ``count`` is the number of
    observations from which the running values were computed.
    """

    mean: Tensor
    deviation: Tensor
    count: Tensor
    _least: Tensor

    def __init__(self, layouts: SpaceLayouts) -> None:
        super().__init__()
        middle, half = initial_scale(layouts)
        self.register_buffer("mean", torch.tensor(middle))
        self.register_buffer("deviation", torch.tensor(half))
        self.register_buffer("count", torch.zeros(1))
        self.register_buffer("_least", torch.tensor(least_deviations(layouts)), persistent=False)

    def forward(self, numbers: Tensor) -> Tensor:
        """Return the scaled numbers [batch, numbers], clipped to [-FARTHEST, FARTHEST]."""
        return ((numbers - self.mean) / self.deviation).clamp(-FARTHEST, FARTHEST)

    def freeze_if_unused(self) -> None:
        """Keep the scale for good if no observation has changed it so far.

        The bounds alone scale the numbers of such weights: these are of an older version, and expect that scale.
        """
        if not self.count.item():
            self._least.zero_()

    def update(self, numbers: Tensor) -> None:
        """Update the running mean and deviation with a batch [batch, numbers].

        With several processes, all must call this method. Source of the formulas: Chan, Golub and
        LeVeque, 1979.
        """
        is_running = self._least > 0
        if not is_running.any():
            return
        batch = numbers.double()
        added = torch.stack([torch.full_like(batch[0], len(batch)), batch.sum(0), batch.square().sum(0)]).cpu()
        if distributed.is_initialized():
            distributed.all_reduce(added)
        added = added.to(numbers.device)
        count, mean = added[0, :1], added[1] / added[0]
        variance = (added[2] / added[0] - mean.square()).clamp(min=0)
        total = self.count.double() + count
        share, delta = count / total, mean - self.mean.double()
        old = torch.where(self.count > 0, self.deviation.double().square(), torch.zeros_like(variance))
        mixed = (
            (1 - share) * old + share * variance + share * (1 - share) * torch.where(self.count > 0, delta, 0).square()
        )
        new_mean = torch.where(self.count > 0, self.mean.double() + share * delta, mean)
        self.mean.copy_(torch.where(is_running, new_mean, self.mean.double()))
        new_deviation = torch.maximum(mixed.sqrt(), self._least.double())
        self.deviation.copy_(torch.where(is_running, new_deviation, self.deviation.double()))
        self.count.copy_(total)


def _encoder(part: ObservationPart, network: Network) -> nn.Sequential:
    layers: list[nn.Module] = []
    for plan in convolutions(part, network):
        layers.append(nn.Conv2d(plan.inputs, plan.outputs, plan.kernel, plan.stride, plan.padding))
        layers.append(resolve_nn_activation(network.activation))
    return nn.Sequential(*layers)


def _numbers(parts: tuple[ObservationPart, ...], obs: Mapping[str, Tensor]) -> Tensor:
    return torch.cat([obs[part.key].float() for part in parts if part.kind == "numbers"], -1)


def _one_hot(part: ObservationPart, indices: Tensor) -> Tensor:
    """Convert categories [batch, n] to one-hot vectors, joined to [batch, sum(sizes)]."""
    columns = [column for column, size in enumerate(part.sizes) for _ in range(size)]
    values = [value for size in part.sizes for value in range(size)]
    taken = indices.float()[:, torch.tensor(columns, device=indices.device)]
    return (taken == torch.tensor(values, dtype=torch.float32, device=indices.device)).float()


def _planes(part: ObservationPart, array: Tensor) -> Tensor:
    """Convert a batch of images or grids to planes [batch, planes, height, width] in [0, 1].

    Images are scaled by their bounds. Each plane of a grid becomes eight planes, one for each bit
    of the categories.
    """
    cells = array.float() if part.planes_first else array.float().permute(0, 3, 1, 2)
    if part.kind == "grid":
        powers = 2.0 ** torch.arange(BITS, device=array.device).reshape(-1, 1, 1)
        return torch.remainder(torch.floor(cells.unsqueeze(2) / powers), 2.0).flatten(1, 2)
    (low, high) = part.bounds[0]
    assert low is not None
    assert high is not None
    return (cells - low) / (high - low)
