"""A description of the encoders that a network has before its fully connected layers.

Numbers are scaled, categories become one-hot vectors, and each image or grid goes through
convolutions. A number with bounds within [-1, 1] is scaled to [-1, 1] by them; any other number by a
running mean and deviation. An image is scaled to [0, 1]. A cell of a grid holds categories, which
are numbers without an order. Each category becomes its eight bits. So the network can tell any two
categories apart, and nobody need list the categories of the game.

The first convolution of a grid has no stride, because neighbouring cells mean different things. To
both grids and images, convolutions with the network's stride are added until the result is at most
ten cells long: otherwise the first fully connected layer would have most of the weights.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import prod
from typing import Final

from tltl_runtime.policies.network import MAX_LAYERS, Network
from tltl_runtime.policies.spaces.layouts import SpaceLayouts
from tltl_runtime.policies.spaces.observation_layout import ObservationPart
from tltlc.api import record

BITS: Final = 8
"""A plane of a grid, whose cells are categories, becomes this many planes: one for each bit."""
NORMALIZER: Final = "normalizer."
"""The prefix of the names of the tensors that scale numbers. They are float32 in a policy."""
DEVIATIONS: Final = "distribution.log_deviation"
"""The name of the logarithms of the standard deviations of an action's numbers."""

_LEAST_UNBOUNDED: Final = 0.01
"""The least running deviation of a number without two bounds."""
_LONGEST: Final = 10
"""Convolutions with a stride are added until both sides of the result are at most this long, in cells."""


@record
class Convolution:
    """A convolution from ``inputs`` to ``outputs`` planes.

    It pads a map with ``kernel // 2`` zeros on each side.
    """

    inputs: int
    outputs: int
    kernel: int
    stride: int

    @property
    def padding(self) -> int:
        """The number of zeros on each side."""
        return self.kernel // 2

    def output_sides(self, sides: Sequence[int]) -> tuple[int, ...]:
        """Return the height and width of the result for a map with these ``sides``."""
        return tuple((side + 2 * self.padding - self.kernel) // self.stride + 1 for side in sides)


def convolutions(part: ObservationPart, network: Network) -> tuple[Convolution, ...]:
    """Return the convolutions through which an image or grid goes, in order."""
    planes, sides = part.planes * (BITS if part.kind == "grid" else 1), tuple(part.sides)
    layers: list[Convolution] = []
    while len(layers) < len(network.channels) or (
        max(sides) > _LONGEST and network.stride > 1 and len(layers) < MAX_LAYERS
    ):
        outputs = network.channels[min(len(layers), len(network.channels) - 1)]
        has_stride = max(sides) > _LONGEST and (layers or part.kind == "image")
        layers.append(Convolution(planes, outputs, network.kernel, network.stride if has_stride else 1))
        planes, sides = outputs, layers[-1].output_sides(sides)
    return tuple(layers)


def map_parts(layouts: SpaceLayouts) -> list[tuple[int, ObservationPart]]:
    """Return the images and grids, each with its index among the parts of an observation."""
    return [(index, part) for index, part in enumerate(layouts.observation) if part.kind in ("image", "grid")]


def number_count(layouts: SpaceLayouts) -> int:
    """Return how many numbers the parts of the kind ``numbers`` have together in an observation."""
    return sum(prod(part.shape) for part in layouts.observation if part.kind == "numbers")


def initial_scale(layouts: SpaceLayouts) -> tuple[list[float], list[float]]:
    """Return an offset and a divisor for each number of an observation, as two lists.

    ``(number - offset) / divisor`` scales the bounds of the number to [-1, 1]. For a number without
    two bounds, the offset is 0 and the divisor 1.
    """
    bounds = [pair for part in layouts.observation if part.kind == "numbers" for pair in part.bounds]
    pairs = [
        (0.0, 1.0) if low is None or high is None else ((low + high) / 2, (high - low) / 2) for low, high in bounds
    ]
    return [middle for middle, _ in pairs], [half for _, half in pairs]


def least_deviations(layouts: SpaceLayouts) -> list[float]:
    """Return for each number of an observation the least running deviation; 0 if its bounds scale it.

    Bounds within [-1, 1] scale a number. Wider bounds are often far beyond what the game ever reaches, so
    a running mean and deviation scale such a number. Its deviation is at least a twentieth of half the
    range, but at most 0.5, so that a flag that is rarely 1 does not become huge.
    """
    bounds = [pair for part in layouts.observation if part.kind == "numbers" for pair in part.bounds]
    return [_least_deviation(low, high) for low, high in bounds]


def _least_deviation(low: float | None, high: float | None) -> float:
    if low is None or high is None:
        return _LEAST_UNBOUNDED
    return 0.0 if low >= -1 and high <= 1 else min((high - low) / 40, 0.5)


def encoded_width(layouts: SpaceLayouts, network: Network) -> int:
    """Return how many numbers the fully connected layers get: those of the encoded observation."""
    width = number_count(layouts) + sum(sum(part.sizes) for part in layouts.observation)
    for _, part in map_parts(layouts):
        sides: tuple[int, ...] = tuple(part.sides)
        layers = convolutions(part, network)
        for layer in layers:
            sides = layer.output_sides(sides)
        width += layers[-1].outputs * prod(sides)
    return width


def space_weight_shapes(network: Network, layouts: SpaceLayouts) -> dict[str, tuple[int, ...]]:
    """Return the shapes of the weights of a policy's network for these layouts, by name."""
    weights: dict[str, tuple[int, ...]] = {}
    if numbers := number_count(layouts):
        weights |= {f"{NORMALIZER}mean": (numbers,), f"{NORMALIZER}deviation": (numbers,), f"{NORMALIZER}count": (1,)}
    for index, part in map_parts(layouts):
        for layer, convolution in enumerate(convolutions(part, network)):
            name = f"encoders.{index}.{2 * layer}"
            kernel = (convolution.kernel, convolution.kernel)
            weights |= {f"{name}.weight": (convolution.outputs, convolution.inputs, *kernel)}
            weights |= {f"{name}.bias": (convolution.outputs,)}
    width = encoded_width(layouts, network)
    for index, outputs in enumerate((*network.hidden, layouts.action.output_width)):
        weights |= {f"mlp.{2 * index}.weight": (outputs, width), f"mlp.{2 * index}.bias": (outputs,)}
        width = outputs
    if layouts.action.number_count:
        weights[DEVIATIONS] = (layouts.action.number_count,)
    return weights
