"""The network of a policy for spaces of any kind, computed by NumPy.

The result is that of :class:`~tltl_runtime.policies.spaces.torch_model.SpaceModel`, apart from
rounding.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.policies.actor import ACTIVATIONS
from tltl_runtime.policies.network import Network
from tltl_runtime.policies.spaces.encoder_plan import (
    BITS,
    DEVIATIONS,
    NORMALIZER,
    Convolution,
    convolutions,
    map_parts,
    space_weight_shapes,
)
from tltl_runtime.policies.spaces.layouts import SpaceLayouts
from tltl_runtime.policies.spaces.observation_layout import ObservationPart

_Array = NDArray[np.float32]

FARTHEST: Final = 10.0
"""A scaled number is clipped to [-FARTHEST, FARTHEST], so that no outlier upsets the network."""
LEAST_LOG, MOST_LOG = -5.0, 1.0
"""The bounds of the logarithm of the standard deviation of an action's number, before it is squashed."""


class SpaceActor:
    """The network of a policy for ``layouts``, with its weights.

    Raises:
        ValueError: the names or shapes of the weights are not those of the network.
    """

    def __init__(self, network: Network, layouts: SpaceLayouts, weights: Mapping[str, NDArray[Any]]) -> None:
        expected = space_weight_shapes(network, layouts)
        given = {name: weight.shape for name, weight in weights.items()}
        wrong = [name for name in sorted(expected.keys() | given.keys()) if expected.get(name) != given.get(name)]
        if wrong:
            raise ValueError(f"the weights are not those of the network that the card describes: {', '.join(wrong)}")
        self._layouts = layouts
        self._weights = {name: weight.astype(np.float32) for name, weight in weights.items()}
        self._activate = ACTIVATIONS[network.activation]
        self._last = len(network.hidden)
        self._maps = [
            (part, [(f"encoders.{index}.{2 * layer}", plan) for layer, plan in enumerate(convolutions(part, network))])
            for index, part in map_parts(layouts)
        ]

    def outputs(self, arrays: Mapping[str, NDArray[Any]]) -> _Array:
        """Return the output of the network for one observation, as a vector.

        ``arrays`` are the parts of the observation, by key. The vector has the logits of all
        choices of an action, and then the means of its continuous numbers.
        """
        # Infinite values give NaN in some operations. The caller checks the result, so no warning is needed.
        with np.errstate(all="ignore"):
            values = self._encoded(arrays)
            for layer in range(self._last + 1):
                values = self._weights[f"mlp.{2 * layer}.weight"] @ values + self._weights[f"mlp.{2 * layer}.bias"]
                if layer < self._last:
                    values = self._activate(values)
            return values

    def choose(self, outputs: _Array, generator: np.random.Generator | None = None) -> NDArray[np.float64]:
        """Return an action for ``outputs`` of the network: sampled, or the likeliest without a generator.

        The action is a row [width]: the choices, which count from 0, and then the continuous
        numbers before they are squashed to their bounds.
        """
        action = self._layouts.action
        logits, means = np.split(outputs.astype(np.float64), [sum(action.sizes)])
        if generator is not None:
            # The Gumbel-max trick: the argmax of logits plus Gumbel noise is a sample of their softmax.
            logits = logits + generator.gumbel(size=len(logits))
            if len(means):
                means = means + deviations(self._weights) * generator.standard_normal(len(means))
        ends = np.cumsum(action.sizes, dtype=np.int64)
        choices = [logits[end - size : end].argmax() for size, end in zip(action.sizes, ends, strict=True)]
        return np.concatenate([np.array(choices, np.float64), means])

    def _encoded(self, arrays: Mapping[str, NDArray[Any]]) -> _Array:
        parts: list[_Array] = []
        numbers = [arrays[part.key] for part in self._layouts.observation if part.kind == "numbers"]
        if numbers:
            mean, deviation = (self._weights[f"{NORMALIZER}{name}"] for name in ("mean", "deviation"))
            scaled = (np.concatenate(numbers).astype(np.float32) - mean) / deviation
            parts.append(np.clip(scaled, -FARTHEST, FARTHEST))
        for part in self._layouts.observation:
            if part.kind == "categories":
                parts += [
                    (np.arange(size) == index).astype(np.float32)
                    for size, index in zip(part.sizes, arrays[part.key], strict=True)
                ]
        for part, layers in self._maps:
            planes = planes_of(part, arrays[part.key])
            for name, plan in layers:
                planes = self._activate(self._convolved(planes, name, plan))
            parts.append(planes.ravel())
        return np.concatenate(parts)

    def _convolved(self, planes: _Array, name: str, plan: Convolution) -> _Array:
        """Convolve planes [inputs, height, width] with the weights ``name``, as one matrix product."""
        weight, bias = self._weights[f"{name}.weight"], self._weights[f"{name}.bias"]
        sides, padding = plan.output_sides(planes.shape[1:]), plan.padding
        padded = np.pad(planes, ((0, 0), (padding, padding), (padding, padding)))
        windows = np.lib.stride_tricks.sliding_window_view(padded, (plan.kernel, plan.kernel), (1, 2))
        windows = windows[:, :: plan.stride, :: plan.stride]
        # The order of a weight [outputs, inputs, kernel, kernel], then one column per cell of the result.
        columns = windows.transpose(0, 3, 4, 1, 2).reshape(weight[0].size, -1)
        result: _Array = (weight.reshape(len(weight), -1) @ columns + bias[:, None]).reshape(-1, *sides)
        return result


def deviations(weights: Mapping[str, NDArray[Any]]) -> NDArray[np.float64]:
    """Return the standard deviation of each number of an action, before it is squashed to its bounds.

    ``weights`` are the weights of a policy, by name.
    """
    logs = np.clip(weights[DEVIATIONS].astype(np.float64), LEAST_LOG, MOST_LOG)
    result: NDArray[np.float64] = np.exp(logs)
    return result


def planes_of(part: ObservationPart, array: NDArray[Any]) -> _Array:
    """Convert the array of an image or grid to planes [planes, height, width] in [0, 1].

    An image is scaled by its bounds. Each plane of a grid becomes eight planes, one for each bit of
    the categories.
    """
    cells = np.asarray(array) if part.planes_first else np.moveaxis(np.asarray(array), -1, 0)
    if part.kind == "grid":
        bits = (cells.astype(np.uint8)[:, None] >> np.arange(BITS, dtype=np.uint8)[:, None, None]) & 1
        planes: _Array = bits.reshape(-1, *cells.shape[1:]).astype(np.float32)
        return planes
    (low, high) = part.bounds[0]
    assert low is not None
    assert high is not None
    scaled: _Array = (cells.astype(np.float32) - np.float32(low)) / np.float32(high - low)
    return scaled
