"""The network of a policy, computed by NumPy, so that playing needs no torch.

The result is that of rsl_rl's ``MLPModel`` or ``CNNModel`` with the configuration from
:func:`~tltl_runtime.policies.network.model_config`, apart from rounding. Weights have the same
names as in these models.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.policies.network import Activation, Network, Shapes

_Array = NDArray[np.float32]


def weight_shapes(network: Network, shapes: Shapes, branches: Sequence[int]) -> dict[str, tuple[int, ...]]:
    """Return the shapes of the weights of a policy's network, by name.

    ``shapes`` are the shapes of the parts of an observation, by key. An action has several discrete
    branches; ``branches`` has the number of choices of each.

    Raises:
        ValueError: the convolutions do not fit a map of the observation.
    """
    weights: dict[str, tuple[int, ...]] = {}
    width = sum(shape[0] for shape in shapes.values() if len(shape) == 1)
    for key, (planes, *size) in _maps(shapes):
        for index, channels in enumerate(network.channels):
            weights[f"cnns.{key}.{2 * index}.weight"] = (channels, planes, network.kernel, network.kernel)
            weights[f"cnns.{key}.{2 * index}.bias"] = (channels,)
            planes, size = channels, [_output_size(cells, network) for cells in size]
        width += planes * math.prod(size)
    for index, outputs in enumerate((*network.hidden, sum(branches))):
        weights[f"mlp.{2 * index}.weight"] = (outputs, width)
        weights[f"mlp.{2 * index}.bias"] = (outputs,)
        width = outputs
    return weights


class Actor:
    """The network of a policy with its weights.

    The observation has vectors (n,) and maps (channels, height, width). Each map goes through
    convolutions. The fully connected layers get first all vectors, then all convolved maps, both in
    the order of the keys in ``shapes``.

    Raises:
        ValueError: the names or shapes of the weights are not those of the network.
    """

    def __init__(
        self, network: Network, shapes: Shapes, branches: Sequence[int], weights: Mapping[str, NDArray[Any]]
    ) -> None:
        expected = weight_shapes(network, shapes, branches)
        given = {name: weight.shape for name, weight in weights.items()}
        wrong = [name for name in sorted(expected.keys() | given.keys()) if expected.get(name) != given.get(name)]
        if wrong:
            raise ValueError(f"the weights are not those of the network that the card describes: {', '.join(wrong)}")
        self._vectors = [key for key, shape in shapes.items() if len(shape) == 1]
        self._maps = [(key, _convolutions(key, shape, network, weights)) for key, shape in _maps(shapes)]
        self._layers = [_layer(weights, f"mlp.{2 * index}") for index in range(len(network.hidden) + 1)]
        self._activate = ACTIVATIONS[network.activation]

    def logits(self, observation: Mapping[str, NDArray[Any]]) -> _Array:
        """Return the logits [sum(branches)] for the observation of one environment."""
        # Infinite values give NaN in some operations. The caller checks the result, so no warning is needed.
        with np.errstate(all="ignore"):
            parts = [np.asarray(observation[key], np.float32) for key in self._vectors]
            for key, convolutions in self._maps:
                planes = np.asarray(observation[key], np.float32)
                for convolution in convolutions:
                    planes = self._activate(convolution(planes))
                parts.append(planes.ravel())
            values = np.concatenate(parts)
            for weight, bias in self._layers[:-1]:
                values = self._activate(weight @ values + bias)
            weight, bias = self._layers[-1]
            logits: _Array = weight @ values + bias
            return logits


def _maps(shapes: Shapes) -> list[tuple[str, tuple[int, ...]]]:
    return [(key, shape) for key, shape in shapes.items() if len(shape) == 3]


def _layer(weights: Mapping[str, NDArray[Any]], name: str) -> tuple[_Array, _Array]:
    return weights[f"{name}.weight"].astype(np.float32), weights[f"{name}.bias"].astype(np.float32)


# --- convolutions ---------------------------------------------------------------------------------------


def _padding(cells: int, network: Network) -> int:
    """Return how many zeros rsl_rl puts on either side of a map that is ``cells`` wide."""
    kernel, stride = network.kernel, network.stride
    return math.ceil((stride * (cells // stride) - cells - stride + kernel) / 2)


def _output_size(cells: int, network: Network) -> int:
    padding = _padding(cells, network)
    size = (cells + 2 * padding - network.kernel) // network.stride + 1
    if padding < 0 or size < 1:
        raise ValueError(
            f"convolutions with a kernel of {network.kernel} and a stride of {network.stride} do not fit a map "
            f"that is {cells} cells wide"
        )
    return size


def _convolutions(
    key: str, shape: tuple[int, ...], network: Network, weights: Mapping[str, NDArray[Any]]
) -> list[_Convolution]:
    sizes = [shape[1:]]
    for _ in network.channels:
        sizes.append(tuple(_output_size(cells, network) for cells in sizes[-1]))
    return [
        _Convolution(_layer(weights, f"cnns.{key}.{2 * index}"), size, network) for index, size in enumerate(sizes[:-1])
    ]


class _Convolution:
    """A convolution of a map [channels, height, width] as one matrix product."""

    def __init__(self, layer: tuple[_Array, _Array], size: Sequence[int], network: Network) -> None:
        weight, bias = layer
        self._weight = weight.reshape(len(weight), -1)
        self._bias = bias[:, None]
        (height, width), (up, left) = size, (_padding(cells, network) for cells in size)
        self._padded = (height + 2 * up, width + 2 * left)
        self._inside = (slice(None), slice(up, up + height), slice(left, left + width))
        self._output = [_output_size(cells, network) for cells in size]
        self._kernel, self._stride = network.kernel, network.stride

    def __call__(self, planes: _Array) -> _Array:
        stride, kernel = self._stride, self._kernel
        padded = np.zeros((len(planes), *self._padded), np.float32)
        padded[self._inside] = planes
        windows = np.lib.stride_tricks.sliding_window_view(padded, (kernel, kernel), (1, 2))[:, ::stride, ::stride]
        # The order of a weight [outputs, channels, kernel, kernel], then one column per cell of the result.
        columns = windows.transpose(0, 3, 4, 1, 2).reshape(self._weight.shape[1], -1)
        result: _Array = (self._weight @ columns + self._bias).reshape(-1, *self._output)
        return result


# --- activations, with the constants of torch -----------------------------------------------------------

_SELU_ALPHA: Final = np.float32(1.6732632423543772)
_SELU_SCALE: Final = np.float32(1.0507009873554805)
_LEAK: Final = np.float32(0.01)
_HALF: Final = np.float32(0.5)
_ROOT_OF_TWO: Final = np.float32(math.sqrt(2))
_erf = np.frompyfunc(math.erf, 1, 1)


def _elu(values: _Array) -> _Array:
    return np.where(values > 0, values, np.expm1(np.minimum(values, 0)))


def _selu(values: _Array) -> _Array:
    result: _Array = _SELU_SCALE * np.where(values > 0, values, _SELU_ALPHA * np.expm1(np.minimum(values, 0)))
    return result


def _sigmoid(values: _Array) -> _Array:
    result: _Array = np.reciprocal(1 + np.exp(-values))
    return result


def _softplus(values: _Array) -> _Array:
    return np.maximum(values, 0) + np.log1p(np.exp(-np.abs(values)))


def _gelu(values: _Array) -> _Array:
    result: _Array = values * _HALF * (1 + _erf(values / _ROOT_OF_TWO).astype(np.float32))
    return result


def _relu(values: _Array) -> _Array:
    return np.maximum(values, 0)


def _leaky_relu(values: _Array) -> _Array:
    return np.where(values > 0, values, _LEAK * values)


def _swish(values: _Array) -> _Array:
    return values * _sigmoid(values)


def _mish(values: _Array) -> _Array:
    return values * np.tanh(_softplus(values))


ACTIVATIONS: Final[Mapping[Activation, Callable[[_Array], _Array]]] = {
    "elu": _elu,
    "selu": _selu,
    "relu": _relu,
    "lrelu": _leaky_relu,
    "tanh": np.tanh,
    "sigmoid": _sigmoid,
    "softplus": _softplus,
    "gelu": _gelu,
    "swish": _swish,
    "mish": _mish,
}
"""The activation functions, by their names in rsl_rl (for ELU: D.-A. Clevert et al., ICLR 2016)."""
